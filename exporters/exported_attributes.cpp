// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/exported_attributes.h"

#include <charconv>

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
               name == attribute::kPointColour;
    return name == attribute::kStrandId || name == attribute::kGroup || name == attribute::kGuide ||
           name == attribute::kRootUv || name == attribute::kRootTriangle ||
           name == attribute::kRootBarycentric || name == attribute::kSelected ||
           name == attribute::kHidden || name == attribute::kFrozen || name == attribute::kLayer;
}

class Collector {
  public:
    Collector(const Groom& groom, const PreparedStrands& strands) : groom_(groom), strands_(strands) {}

    std::vector<ExportedAttribute> run() {
        addIds();
        addGroups();
        if (const auto guides = ofStrands<std::uint8_t>(attribute::kGuide); !guides.empty())
            add("groom_guide", false, guides, strands_.sources);
        addVectors("groom_root_uv", false, rootUvs(groom_, strands_), false);
        addVectors("groom_color", true, strands_.colours, true);
        for (const auto& [name, data] : groom_.strandAttributes.all())
            addOther(name, data, false, groom_.strandCount(), strands_.sources);
        if (strands_.isResampled) return std::move(result_);
        std::vector<std::uint32_t> points;
        for (const std::uint32_t source : strands_.sources) {
            for (std::uint32_t p = groom_.offsets[source]; p < groom_.offsets[source + 1]; ++p)
                points.push_back(p);
        }
        for (const auto& [name, data] : groom_.pointAttributes.all())
            addOther(name, data, true, groom_.pointCount(), points);
        return std::move(result_);
    }

  private:
    template <class T>
    std::span<const T> ofStrands(std::string_view name) const {
        const auto values = groom_.strandAttributes.view<T>(name);
        return values.size() == groom_.strandCount() ? values : std::span<const T>();
    }

    ExportedAttribute& start(const std::string& name, bool perPoint, Type type, std::uint32_t components) {
        ExportedAttribute attribute;
        attribute.name = name;
        attribute.perPoint = perPoint;
        attribute.type = type;
        attribute.components = components;
        result_.push_back(std::move(attribute));
        return result_.back();
    }

    void addIds() {
        ExportedAttribute& ids = start("groom_id", false, Type::Whole, 1);
        const auto own = ofStrands<std::uint32_t>(attribute::kStrandId);
        for (const std::uint32_t source : strands_.sources)
            ids.whole.push_back(static_cast<std::int32_t>(own.empty() ? source : own[source]));
    }

    void addGroups() {
        const auto groups = ofStrands<std::uint32_t>(attribute::kGroup);
        if (groups.empty()) return;
        ExportedAttribute& numbers = start("groom_group_id", false, Type::Whole, 1);
        for (const std::uint32_t source : strands_.sources)
            numbers.whole.push_back(groupNumber(groom_, groups[source]));
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
        if (isCarriedOtherwise(name, perPoint) || sizeOf(data) != elements) return;
        std::visit([&](const auto& array) { add(name, perPoint, array.view(), chosen); }, data);
    }

    template <class T>
    void add(const std::string& name, bool perPoint, std::span<const T> values,
             const std::vector<std::uint32_t>& chosen) {
        if constexpr (std::is_integral_v<T>) {
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
    const PreparedStrands& strands_;
    std::vector<ExportedAttribute> result_;
};

}  // namespace

std::vector<ExportedAttribute> exportedAttributes(const Groom& groom, const PreparedStrands& strands) {
    return Collector(groom, strands).run();
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
