// SPDX-License-Identifier: MIT
// What an asset's records stand for: strands, settings, follow hairs.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "asset/asset_points.h"
#include "hairloom/asset.h"

namespace hairloom::runtime {

using namespace asset;

namespace {

Float3 positionOf(const AssetGrid& grid, double step) {
    return {static_cast<float>(static_cast<double>(grid[0]) * step),
            static_cast<float>(static_cast<double>(grid[1]) * step),
            static_cast<float>(static_cast<double>(grid[2]) * step)};
}

Float3 toFloat3(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

double stepOf(std::uint32_t gridBits) {
    return std::ldexp(1.0, -static_cast<int>(gridBits));
}

/// Sets what the asset says of a field, where the field can have it.
void setField(const Asset& asset, const Setting& setting, const Field<SimulationSettings>& field,
              SimulationSettings& settings) {
    const auto values = asset.valuesOf(setting);
    switch (setting.kind) {
        case ValueKind::numbers:
            if (field.kind == FieldKind::Ramp || field.kind == FieldKind::Choice ||
                values.size() != field.components())
                return;
            for (std::uint32_t c = 0; c < values.size(); ++c) setFieldValue(settings, field, values[c], c);
            return;
        case ValueKind::choice:
            for (std::size_t c = 0; c < field.choices.size(); ++c) {
                if (field.choices[c] == asset.choiceOf(setting))
                    setFieldValue(settings, field, static_cast<double>(c));
            }
            return;
        case ValueKind::ramp: {
            if (field.kind != FieldKind::Ramp) return;
            std::array<Ramp::Key, Ramp::kMaxKeys> keys{};
            for (std::size_t k = 0; k < values.size(); ++k)
                (k % 2 == 0 ? keys[k / 2].at : keys[k / 2].value) = static_cast<float>(values[k]);
            const Ramp ramp = Ramp::of(std::span(keys).first(values.size() / 2));
            if (validationError(ramp).empty()) member<Ramp>(settings, field) = ramp;
            return;
        }
        case ValueKind::seed:
            return;  // the engine has none of 64 bits
    }
}

}  // namespace

Float3 Asset::boundsMin_ss() const {
    return toFloat3(header().boundsMin);
}
Float3 Asset::boundsMax_ss() const {
    return toFloat3(header().boundsMax);
}

std::uint32_t Asset::hairCount() const {
    if (recipe.empty()) return 0;
    if (guideHairs.empty()) return recipe[0].hairsPerGuide * static_cast<std::uint32_t>(guides.size());
    return std::accumulate(guideHairs.begin(), guideHairs.end(), 0u);
}

std::uint32_t Asset::hairsOf(std::size_t guide) const {
    return guideHairs.empty() ? recipe[0].hairsPerGuide : guideHairs[guide];
}

Asset::Strands Asset::strandsAtRest() const {
    Strands decoded;
    decoded.offsets.reserve(strands.size() + 1);
    decoded.offsets.push_back(0);
    decoded.positions_ss.reserve(pointCount());
    const std::byte* residual = residuals.data();
    for (const Strand& strand : strands) {
        const double step = stepOf(strand.gridBits);
        forPoints(strand, residual,
                  [&](const AssetGrid& at) { decoded.positions_ss.push_back(positionOf(at, step)); });
        decoded.offsets.push_back(static_cast<std::uint32_t>(decoded.positions_ss.size()));
    }
    return decoded;
}

double Asset::greatestError() const {
    std::uint32_t coarsest = kMaxGridBits;
    for (const Strand& strand : strands) coarsest = std::min<std::uint32_t>(coarsest, strand.gridBits);
    return 0.5 * std::sqrt(3.0) * stepOf(coarsest);
}

std::span<const double> Asset::valuesOf(const Setting& setting) const {
    return values.subspan(setting.firstValue, setting.count);
}

std::string_view Asset::text(Text place) const {
    return {texts.data() + place.at, place.bytes};
}

std::string_view Asset::nameOf(const Setting& setting) const {
    return text({setting.name, setting.nameBytes});
}

std::string_view Asset::choiceOf(const Setting& setting) const {
    const auto place = valuesOf(setting);
    return text({static_cast<std::uint32_t>(place[0]), static_cast<std::uint32_t>(place[1])});
}

const Setting* Asset::findSetting(std::string_view name) const {
    const auto found =
        std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return nameOf(s) == name; });
    return found == settings.end() ? nullptr : &*found;
}

double Asset::numberOf(std::string_view name, double missing) const {
    const Setting* const setting = findSetting(name);
    return setting && setting->kind == ValueKind::numbers && setting->count == 1 ? valuesOf(*setting)[0]
                                                                                 : missing;
}

SimulationSettings Asset::simulation() const {
    constexpr std::string_view kGroup = "simulation.";
    SimulationSettings result;
    for (const Setting& setting : settings) {
        std::string_view name = nameOf(setting);
        if (!name.starts_with(kGroup)) continue;
        name.remove_prefix(kGroup.size());
        if (const auto* field = findField<SimulationSettings>(name)) setField(*this, setting, *field, result);
    }
    return result;
}

std::span<const std::byte> Asset::valuesOf(const Attribute& attribute) const {
    return attributeValues().subspan(attribute.firstByte,
                                     static_cast<std::size_t>(bytesOf(attribute)) * strands.size());
}

const Attribute* Asset::findAttribute(std::string_view name) const {
    const auto all = attributes();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Attribute& a) { return nameOf(a) == name; });
    return found == all.end() ? nullptr : &*found;
}

std::span<const float> Asset::strandStiffness() const {
    const Attribute* const attribute = minor() < kMinorOfStiffness ? nullptr : findAttribute(kStiffnessName);
    if (!attribute) return {};
    return {reinterpret_cast<const float*>(valuesOf(*attribute).data()), strands.size()};
}

BodyFieldRead Asset::readBody() const {
    const std::span<const std::byte> bytes = body();
    return bodyFieldFromBytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

Vector<std::size_t> Asset::bonesOf(const BodyField& field) const {
    Vector<std::size_t> numbers;
    for (const String& name : field.bones) {
        const auto found = std::find_if(bones.begin(), bones.end(),
                                        [&](const Bone& bone) { return text(bone.name) == name; });
        if (found != bones.end()) numbers.push_back(static_cast<std::size_t>(found - bones.begin()));
    }
    return numbers;
}

DrawnHairs Asset::drawnHairs(const Strands& rest, const Host& host) const {
    const Recipe& r = recipe[0];
    Vector<std::uint32_t> ids, layersOfGuides;
    Vector<Float3> rootsOfGuides, quarters, tips;
    Vector<float> lengths;
    for (const Guide& guide : guides) {
        const auto points = std::span(rest.positions_ss)
                                .subspan(rest.offsets[guide.strand],
                                         rest.offsets[guide.strand + 1] - rest.offsets[guide.strand]);
        ids.push_back(guide.id);
        rootsOfGuides.push_back(points.front());
        tips.push_back(points.back());
        lengths.push_back(polylineLength(points));
        if (minor() < kMinorOfPartedRoots) continue;
        layersOfGuides.push_back(layerOf(guide.strand));
        quarters.push_back(pointAtShare(points, FollowRecipe::kQuarter));
    }
    Vector<std::uint32_t> hairs(guides.size());
    for (std::size_t guide = 0; guide < hairs.size(); ++guide) hairs[guide] = hairsOf(guide);
    Vector<std::array<std::uint32_t, 3>> triangles;
    Vector<float> areas;
    for (const GuideTriangle& triangle : guideTriangles) {
        triangles.push_back(triangle.guides);
        areas.push_back(triangle.area);
    }
    DrawnHairs drawn = drawFollowHairs({r.seed,
                                        hairs,
                                        r.blend,
                                        numberOf("interpolation.drawGuides", 0) != 0,
                                        {r.beginAngle, r.endAngle, r.beginSpread, r.endSpread},
                                        ids,
                                        layersOfGuides,
                                        rootsOfGuides,
                                        quarters,
                                        tips,
                                        lengths,
                                        triangles,
                                        areas},
                                       host);
    for (auto& hair : drawn.guides) {
        for (std::uint32_t& guide : hair) guide = guides[guide].strand;
    }
    return drawn;
}

Asset::FollowArrays Asset::followArrays(const Strands& rest, const Host& host) const {
    const Recipe& r = recipe[0];
    FollowArrays arrays;
    arrays.planes.assign(strands.size(), RootPlane{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    for (const Guide& guide : guides) {
        const Float3 normal = toFloat3(guide.normal), axis = toFloat3(guide.axis);
        arrays.planes[guide.strand] = {axis, cross(normal, axis), normal};
    }
    arrays.drawn = drawnHairs(rest, host);
    arrays.shifts.resize(hairCount());
    for (std::size_t hair = 0; hair < rootShifts.size(); ++hair)
        arrays.shifts[hair] =
            shiftDirection(arrays.planes, arrays.drawn.guides[hair], arrays.drawn.rootWeights[hair]) *
            (static_cast<float>(rootShifts[hair]) * r.shiftStep);
    for (const FarRootShift& far : farRootShifts)
        arrays.shifts[far.hair] = Float3{static_cast<float>(far.shift[0]), static_cast<float>(far.shift[1]),
                                         static_cast<float>(far.shift[2])} *
                                  kFarShiftStep;
    arrays.radii = wispRadii(r.radiusRoot, r.radiusTip, r.pointsPerHair);
    return arrays;
}

FollowView Asset::followView(const Strands& rest, const FollowArrays& arrays) const {
    FollowView view;
    view.guideOffsets = rest.offsets;
    view.guideRestPositions_ss = rest.positions_ss;
    view.rootPlanes_ss = arrays.planes;
    view.pointsPerHair = recipe[0].pointsPerHair;
    view.radii = arrays.radii;
    view.wisps = wispMotion();
    view.guides = arrays.drawn.guides;
    view.weights = arrays.drawn.weights;
    view.rootWeights = arrays.drawn.rootWeights;
    view.wispOffsets = arrays.drawn.wispOffsets;
    view.blends = arrays.drawn.blends;
    view.rootShifts = arrays.shifts;
    return view;
}

WispMotion Asset::wispMotion() const {
    const WispMotion usual;  // of files from before wisps had settings
    const auto value = [&](std::string_view name, float missing, float least, float most) {
        const auto found = static_cast<float>(numberOf(name, static_cast<double>(missing)));
        return found >= least && found <= most ? found : missing;
    };
    return {value("interpolation.wispSpread", usual.spread, 0.0f, kMostSpread),
            value("interpolation.wispSpreadLimit", usual.limit, 1.0f, kMostWidening)};
}

FollowHairs::Result Asset::followHairs(const Strands& rest, const Host& host) const {
    if (hairCount() == 0) return {std::nullopt, "the asset has no follow hairs"};
    const FollowArrays arrays = followArrays(rest, host);
    return FollowHairs::make(followView(rest, arrays));
}

}  // namespace hairloom::runtime
