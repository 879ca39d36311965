// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/exported_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "core/groom/point_width.h"
#include "core/groom/poses.h"
#include "core/groom/strand_subset.h"
#include "importers/attribute_units.h"

namespace hairloom {
namespace {

using Type = ExportedAttribute::Type;

/// The number of a group: that of the file it came from ("group 7"), else its place in the list.
std::int32_t groupNumber(const Groom& groom, std::uint32_t group) {
    constexpr std::string_view kPrefix = "group ";
    const auto place = static_cast<std::int32_t>(group);
    if (group >= groom.groupNames.size() || !groom.groupNames[group].starts_with(kPrefix)) return place;
    const std::string& name = groom.groupNames[group];
    std::int32_t named = 0;
    const char* const end = name.data() + name.size();
    const auto [at, code] = std::from_chars(name.data() + kPrefix.size(), end, named);
    return code == std::errc() && at == end ? named : place;
}

/// What has a name of its own in the file, belongs to the scalp, or is a tool's state.
bool isCarriedOtherwise(std::string_view name, bool perPoint) {
    if (perPoint)
        return name == attribute::kPosition || isOperatorAttribute(name) || name == attribute::kRadius ||
               name == attribute::kWidthChange || name == attribute::kPointColour ||
               name.starts_with(kPosePrefix);
    return name == attribute::kStrandId || name == attribute::kGroup || name == attribute::kGuide ||
           name == attribute::kRootUv || name == attribute::kRootTriangle ||
           name == attribute::kRootBarycentric || name == attribute::kSelected ||
           name == attribute::kHidden || name == attribute::kFrozen || name == attribute::kLayer;
}

/// The names that the exporter gives by itself.
constexpr std::string_view kId = "groom_id", kGroupId = "groom_group_id", kGuideFlag = "groom_guide",
                           kRootUvs = "groom_root_uv", kColours = "groom_color", kWidths = "groom_width",
                           kDisplayColours = "displayColor";

class Collector {
  public:
    Collector(const Groom& groom, PreparedStrands& strands, const ExportNames& names)
        : groom_(groom), strands_(strands), names_(names), giver_(names.isLegal) {
        for (const std::string_view taken : names.taken) giver_.reserve(taken);
    }

    std::vector<ExportedAttribute> run() {
        addOwn();
        for (const auto& [name, data] : groom_.strandAttributes.all())
            addOther(name, data, false, groom_.strandCount(), strands_.sources);
        if (!strands_.isResampled) {
            std::vector<std::uint32_t> points;
            for (const std::uint32_t source : strands_.sources) {
                for (std::uint32_t p = groom_.offsets[source]; p < groom_.offsets[source + 1]; ++p)
                    points.push_back(p);
            }
            for (const auto& [name, data] : groom_.pointAttributes.all())
                addOther(name, data, true, groom_.pointCount(), points);
        }
        return std::move(result_);
    }

  private:
    void addOwn() {
        if (!isAuthors(kId)) addIds();
        if (!isAuthors(kGroupId)) addGroups();
        if (const auto guides = ofStrands<std::uint8_t>(attribute::kGuide);
            !guides.empty() && !isAuthors(kGuideFlag))
            add(std::string(kGuideFlag), false, guides, strands_.sources);
        if (!isAuthors(kRootUvs)) addVectors(std::string(kRootUvs), false, rootUvs(groom_, strands_), false);
        // Programs look for colours under either name.
        addVectors(std::string(!isAuthors(kColours)          ? kColours
                               : !isAuthors(kDisplayColours) ? kDisplayColours
                                                             : "groom_point_color"),
                   true, strands_.colours, true);
        if (names_.isUnreal && !isAuthors(kWidths)) {
            ExportedAttribute& widths = start(std::string(kWidths), true, Type::Number, 1);
            widths.numbers = strands_.thickness;
        }
    }

    /// Whether the groom has the name itself and the file gets that.
    bool isAuthors(std::string_view name) const {
        const auto fits = [&](const AttributeSet& set, std::size_t elements) {
            const auto found = set.all().find(name);
            return found != set.all().end() && sizeOf(found->second) == elements;
        };
        return fits(groom_.strandAttributes, groom_.strandCount()) ||
               (!strands_.isResampled && fits(groom_.pointAttributes, groom_.pointCount()));
    }

    template <class T>
    std::span<const T> ofStrands(std::string_view name) const {
        const auto values = groom_.strandAttributes.view<T>(name);
        return values.size() == groom_.strandCount() ? values : std::span<const T>();
    }

    ExportedAttribute& start(const std::string& name, bool perPoint, Type type, std::uint32_t components) {
        ExportedAttribute attribute;
        attribute.name = giver_.give(name);
        if (attribute.name != name) attribute.original = name;
        attribute.perPoint = perPoint;
        attribute.type = type;
        attribute.components = components;
        result_.push_back(std::move(attribute));
        return result_.back();
    }

    void addIds() {
        const auto own = ofStrands<std::uint32_t>(attribute::kStrandId);
        std::vector<std::uint32_t> ids;
        for (const std::uint32_t source : strands_.sources) ids.push_back(own.empty() ? source : own[source]);
        start(std::string(kId), false, Type::Whole, 1).whole = narrowed(kId, ids);
    }

    void addGroups() {
        const auto groups = ofStrands<std::uint32_t>(attribute::kGroup);
        if (groups.empty() && names_.isUnreal) return addLayersAsGroups();
        if (groups.empty()) return;
        ExportedAttribute& numbers = start(std::string(kGroupId), false, Type::Whole, 1);
        for (const std::uint32_t source : strands_.sources)
            numbers.whole.push_back(groupNumber(groom_, groups[source]));
    }

    void addLayersAsGroups() {
        const auto layers = ofStrands<std::uint32_t>(attribute::kLayer);
        if (layers.empty() || groom_.layers.size() < 2) return;
        ExportedAttribute& numbers = start(std::string(kGroupId), false, Type::Whole, 1);
        for (const std::uint32_t source : strands_.sources)
            numbers.whole.push_back(static_cast<std::int32_t>(layers[source]));
    }

    /// Files have signed numbers of 32 bits: what these do not hold is numbered anew, alike ones alike.
    std::vector<std::int32_t> narrowed(std::string_view name, const std::vector<std::uint32_t>& numbers) {
        if (std::ranges::all_of(numbers, [](std::uint32_t number) { return number <= INT32_MAX; }))
            return {numbers.begin(), numbers.end()};
        std::vector<std::uint32_t> different = numbers;
        std::ranges::sort(different);
        different.erase(std::unique(different.begin(), different.end()), different.end());
        std::vector<std::int32_t> narrow;
        for (const std::uint32_t number : numbers)
            narrow.push_back(
                static_cast<std::int32_t>(std::ranges::lower_bound(different, number) - different.begin()));
        strands_.findings.push_back({Severity::Warning,
                                     fmt::format("{} has numbers above {}", name, INT32_MAX),
                                     std::string(name), "the file has them numbered from 0 in their order"});
        return narrow;
    }

    template <class Vector>
    void addVectors(const std::string& name, bool perPoint, const std::vector<Vector>& values,
                    bool isColour) {
        if (values.empty()) return;
        std::vector<std::uint32_t> all(values.size());
        for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
        add(name, perPoint, std::span<const Vector>(values), all);
        result_.back().isColour = isColour;
    }

    void addOther(const std::string& name, const AttributeData& data, bool perPoint, std::size_t elements,
                  const std::vector<std::uint32_t>& chosen) {
        const bool isBase = perPoint && names_.hasOperators && isOperatorAttribute(name);
        if ((isCarriedOtherwise(name, perPoint) && !isBase) || sizeOf(data) != elements) return;
        std::visit([&](const auto& array) { add(name, perPoint, array.view(), chosen); }, data);
        ExportedAttribute& added = result_.back();
        added.isColour = added.components == 3 && (name == kColours || name == kDisplayColours);
        toFileUnit(name, added);
    }

    /// The groom's are metres, Y up.
    void toFileUnit(const std::string& name, ExportedAttribute& attribute) const {
        const AttributeUnit unit = attributeUnit(name, attribute.components);
        if (attribute.type != Type::Number || unit == AttributeUnit::None) return;
        if (unit == AttributeUnit::Length) {
            if (strands_.metresPerUnit == 1) return;
            for (float& length : attribute.numbers) length /= strands_.metresPerUnit;
            return;
        }
        StrandExportOptions options;
        options.metresPerUnit = strands_.metresPerUnit;
        options.up = strands_.up;
        for (std::size_t i = 0; i + 2 < attribute.numbers.size(); i += 3) {
            Eigen::Map<Vec3f> value(&attribute.numbers[i]);
            value = toFile(value, options);
        }
    }

    template <class T>
    void add(const std::string& name, bool perPoint, std::span<const T> values,
             const std::vector<std::uint32_t>& chosen) {
        if constexpr (std::is_same_v<T, std::uint32_t>) {
            std::vector<std::uint32_t> numbers;
            for (const std::uint32_t index : chosen) numbers.push_back(values[index]);
            std::vector<std::int32_t> narrow = narrowed(name, numbers);
            start(name, perPoint, Type::Whole, 1).whole = std::move(narrow);
        } else if constexpr (std::is_integral_v<T>) {
            ExportedAttribute& to = start(name, perPoint, sizeof(T) == 1 ? Type::Flag : Type::Whole, 1);
            for (const std::uint32_t index : chosen)
                to.whole.push_back(static_cast<std::int32_t>(values[index]));
        } else if constexpr (std::is_same_v<T, float>) {
            ExportedAttribute& to = start(name, perPoint, Type::Number, 1);
            for (const std::uint32_t index : chosen) to.numbers.push_back(values[index]);
        } else {
            constexpr auto kComponents = static_cast<std::uint32_t>(T::RowsAtCompileTime);
            ExportedAttribute& to = start(name, perPoint, Type::Number, kComponents);
            for (const std::uint32_t index : chosen)
                to.numbers.insert(to.numbers.end(), values[index].data(), values[index].data() + kComponents);
        }
    }

    const Groom& groom_;
    PreparedStrands& strands_;
    const ExportNames& names_;
    NameGiver giver_;
    std::vector<ExportedAttribute> result_;
};

/// Whether the file said a number alone, or nothing.
bool isNumbered(const std::string& group) {
    constexpr std::string_view kPrefix = "group ";
    const auto isDigit = [](char c) { return (c >= '0' && c <= '9') || c == '-'; };
    return group == "no group" ||
           (group.starts_with(kPrefix) && std::ranges::all_of(group.substr(kPrefix.size()), isDigit));
}

bool isLegalInPly(char c, bool) {
    return static_cast<unsigned char>(c) > 0x20 && c != 0x7f;
}

}  // namespace

ExportNames usdNames(bool operators) {
    // Of curves: a primvar of such a name would go before the attribute. Blender takes the last two for its
    // own.
    ExportNames names{isLegalInUsd, {"widths", "normals", "radius", "position"}};
    names.hasOperators = operators;
    return names;
}

ExportNames alembicNames(bool unreal) {
    ExportNames names{isLegalInAlembic, {}};
    names.isUnreal = unreal;
    if (unreal) names.taken = {"groom_closest_guides", "groom_group_name"};
    return names;
}

ExportNames plyNames() {
    return {isLegalInPly, {"x", "y", "z", "width", "radius", "red", "green", "blue"}};
}

std::vector<ExportedAttribute> exportedAttributes(const Groom& groom, PreparedStrands& strands,
                                                  const ExportNames& names) {
    std::vector<ExportedAttribute> attributes = Collector(groom, strands, names).run();
    // As the file has them: Unreal's is one of three numbers.
    constexpr std::string_view kClosest = "groom_closest_guides";
    const auto isPart = [&](const ExportedAttribute& attribute) {
        return names.isUnreal && attribute.name.starts_with(kClosest) &&
               attribute.name.size() == kClosest.size() + 2;
    };
    for (const ExportedAttribute& attribute : attributes) {
        if (!isPart(attribute))
            strands.names.push_back(attribute.name);
        else if (std::ranges::count(strands.names, kClosest) == 0)
            strands.names.emplace_back(kClosest);
    }
    return attributes;
}

std::vector<std::string> unrealGroupNames(const Groom& groom, const PreparedStrands& strands) {
    const auto groups = groom.strandAttributes.view<std::uint32_t>(attribute::kGroup);
    const std::vector<std::uint32_t> layers = layersOfStrands(groom);
    std::vector<std::string> names;
    bool isNamed = false;
    for (const std::uint32_t source : strands.sources) {
        std::string name;
        if (groups.size() == groom.strandCount() && groups[source] < groom.groupNames.size())
            name = groom.groupNames[groups[source]];
        if (name.empty() || isNumbered(name))
            name = layers[source] < groom.layers.size() ? groom.layers[layers[source]].name : std::string();
        isNamed = isNamed || name != Layer{}.name;
        names.push_back(std::move(name));
    }
    if (!isNamed) names.clear();
    return names;
}

std::size_t roomOf(const PreparedStrands& strands, std::span<const ExportedAttribute> attributes) {
    constexpr std::size_t kTables = 65536;
    std::size_t bytes = kTables + strands.positions.size() * sizeof(Vec3f) * (1 + strands.frames.size()) +
                        strands.thickness.size() * sizeof(float) +
                        strands.offsets.size() * sizeof(std::uint32_t);
    for (const ExportedAttribute& attribute : attributes)
        bytes += (attribute.numbers.size() + attribute.whole.size()) * sizeof(float);
    return bytes;
}

}  // namespace hairloom
