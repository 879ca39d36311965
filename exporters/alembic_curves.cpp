// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/alembic_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "exporters/exported_attributes.h"
#include "exporters/exported_parts.h"
#include "exporters/ogawa_builder.h"
#include "exporters/unreal_script.h"

namespace hairloom {
namespace {

constexpr const char* kCurveSchema = "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1";
constexpr const char* kCurveObject =
    "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1;schemaObjTitle=AbcGeom_Curve_v2:.geom";
constexpr const char* kGroupName = "groom_group_name";
constexpr const char* kXformSchema = "schema=AbcGeom_Xform_v3";
constexpr const char* kXformObject = "schema=AbcGeom_Xform_v3;schemaObjTitle=AbcGeom_Xform_v3:.xform";

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

/// "arrayExtent=1;geoScope=uni;…" as AbcGeom writes it of a parameter of curves.
std::string parameter(std::string_view scope, std::string_view pod, std::uint32_t podExtent = 1,
                      std::uint32_t arrayExtent = 1, std::string_view interpretation = {}) {
    return fmt::format("arrayExtent={};geoScope={};{}isGeomParam=true;podExtent={};podName={}", arrayExtent,
                       scope, interpretation.empty() ? "" : fmt::format("interpretation={};", interpretation),
                       podExtent, pod);
}

class CurvesWriter {
  public:
    CurvesWriter(const Groom& groom, PreparedStrands& strands, const StrandExportOptions& options,
                 bool unreal)
        : strands_(strands),
          attributes_(exportedAttributes(groom, strands, alembicNames(unreal))),
          parts_(exportedParts(groom, strands, isLegalInAlembic)),
          frames_(options.frames.get()),
          watch_(options.watch),
          unreal_(unreal) {
        if (unreal) groupNames_ = unrealGroupNames(groom, strands);
        if (!groupNames_.empty()) strands.names.emplace_back(kGroupName);
        file_.reserve(roomOf(strands, attributes_));
        if (frames_ == nullptr) return;
        times_ = {static_cast<std::uint32_t>(frames_->points.size()), 1 / frames_->framesPerSecond, {}};
        for (std::size_t i = 0; i < frames_->exposures.size(); ++i)
            times_.cycle.push_back(frames_->numberOf(i) / frames_->framesPerSecond);
    }

    std::vector<std::byte> write() {
        std::vector<AlembicChild> hair;
        for (const ExportedPart& part : parts_) {
            const AlembicChild curves{
                parts_.size() == 1 ? part.name : "hair", kCurveObject,
                alembicObject(file_, metadata_, objectOf(".geom", geometry(part), kCurveSchema), {})};
            // Blender shows curves under the name of what stands above them.
            hair.push_back(parts_.size() == 1 ? curves : below(part.name, std::span(&curves, 1), compound()));
        }
        const AlembicChild root = below("groom", hair, rootParameters());
        const std::uint64_t top = alembicObject(file_, metadata_, 0, std::span(&root, 1));
        return finishAlembic(file_, metadata_, top,
                             "_ai_AlembicVersion=Alembic 1.8.3;_ai_Application=Hairloom", times_);
    }

    std::span<const ExportedAttribute> attributes() const { return attributes_; }

  private:
    AlembicCompound compound() { return AlembicCompound(file_, metadata_); }

    std::uint64_t objectOf(const std::string& name, const AlembicCompound& inside,
                           const std::string& metadata) {
        AlembicCompound properties = compound();
        properties.compound(name, inside, metadata);
        return properties.write();
    }

    /// A transform that moves nothing.
    AlembicChild below(const std::string& name, std::span<const AlembicChild> children,
                       const AlembicCompound& parameters) {
        AlembicCompound xform = compound();
        const std::uint8_t inherits = 1;
        xform.scalar(".inherits", AlembicType::Bool, 1, std::as_bytes(std::span(&inherits, 1)));
        if (!parameters.isEmpty()) xform.compound(".arbGeomParams", parameters);
        return {name, kXformObject,
                alembicObject(file_, metadata_, objectOf(".xform", xform, kXformSchema), children)};
    }

    AlembicCompound rootParameters() {
        AlembicCompound parameters = compound();
        if (!unreal_) return parameters;
        const auto text = [&](const std::string& name, const std::string& value) {
            parameters.scalar(name, AlembicType::Text, 1,
                              std::as_bytes(std::span(value.c_str(), value.size() + 1)));
        };
        const auto version = [&](const std::string& name, std::int16_t value) {
            parameters.scalar(name, AlembicType::Int16, 1, std::as_bytes(std::span(&value, 1)));
        };
        version("groom_version_major", 1);
        version("groom_version_minor", 5);
        text("groom_tool", "Hairloom");
        text("groom_properties", "");
        return parameters;
    }

    static std::array<double, 6> boxOf(std::span<const Vec3f> positions) {
        Box3f bounds;
        for (const Vec3f& position : positions) bounds.extend(position);
        std::array<double, 6> box{};
        for (int axis = 0; axis < 3; ++axis) {
            box[static_cast<std::size_t>(axis)] = double{bounds.min()[axis]};
            box[static_cast<std::size_t>(axis) + 3] = double{bounds.max()[axis]};
        }
        return box;
    }

    /// Once, or at each time.
    void addPoints(AlembicCompound& curves, const ExportedPart& part) {
        std::vector<std::span<const Vec3f>> shapes;
        for (const std::vector<Vec3f>& frame : strands_.frames) shapes.push_back(part.points(frame));
        if (shapes.empty()) shapes.push_back(part.points(strands_.positions));
        std::vector<std::array<double, 6>> boxes;
        for (const auto& shape : shapes) boxes.push_back(boxOf(shape));
        std::vector<std::span<const std::byte>> boxSamples, pointSamples;
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            boxSamples.push_back(std::as_bytes(std::span(boxes[i])));
            pointSamples.push_back(std::as_bytes(shapes[i]));
        }
        curves.scalars(".selfBnds", AlembicType::Double, 6, boxSamples, "interpretation=box");
        curves.arrays("P", AlembicType::Float, 3, pointSamples, "geoScope=vtx;interpretation=point");
        if (shapes.size() < 2) return;
        std::vector<std::vector<Vec3f>> velocities;
        for (std::size_t f = 0; f < shapes.size(); ++f) {
            if (watch_.isCancelled()) return;
            velocities.push_back(pointVelocities(shapes, f, *frames_));
        }
        std::vector<std::span<const std::byte>> velocitySamples;
        for (const auto& velocity : velocities) velocitySamples.push_back(bytesOf(velocity));
        curves.arrays(".velocities", AlembicType::Float, 3, velocitySamples,
                      "geoScope=vtx;interpretation=vector");
    }

    AlembicCompound geometry(const ExportedPart& part) {
        AlembicCompound curves = compound();
        addPoints(curves, part);
        curves.array("nVertices", AlembicType::Int32, 1, bytesOf(part.vertexCounts(strands_)));
        // Polylines, and no basis: Blender looks at the basis alone, and takes half the points of any other.
        constexpr std::array<std::uint8_t, 4> kLinear{1, 0, 0, 0};
        curves.scalar("curveBasisAndType", AlembicType::Uint8, 4, std::as_bytes(std::span(kLinear)));
        curves.array("width", AlembicType::Float, 1, std::as_bytes(part.widths(strands_)),
                     parameter("vtx", "float32_t"));
        AlembicCompound parameters = compound();
        addParameters(parameters, part);
        curves.compound(".arbGeomParams", parameters);
        // Unreal's groups have names of their own.
        if (!part.displayName.empty() && !unreal_) {
            AlembicCompound ofObject = compound();
            const std::string& name = part.displayName;
            ofObject.scalar(kGroupName, AlembicType::Text, 1,
                            std::as_bytes(std::span(name.c_str(), name.size() + 1)));
            curves.compound(".userProperties", ofObject);
        }
        return curves;
    }

    void addParameters(AlembicCompound& out, const ExportedPart& part) {
        std::array<const ExportedAttribute*, 3> closest{};
        for (const ExportedAttribute& attribute : attributes_) {
            if (const auto k = closestGuidesIndex(attribute.name); k && unreal_)
                closest[*k] = &attribute;
            else
                addParameter(out, attribute, part);
        }
        if (unreal_) addClosestGuides(out, closest);
        if (!groupNames_.empty()) out.texts(kGroupName, groupNames_, parameter("uni", "string"));
    }

    static void addParameter(AlembicCompound& out, const ExportedAttribute& attribute,
                             const ExportedPart& part) {
        const std::string_view scope = attribute.perPoint ? "vtx" : "uni";
        const auto whole = attribute.type == ExportedAttribute::Type::Number ? std::span<const std::int32_t>()
                                                                             : part.wholes(attribute);
        if (attribute.type == ExportedAttribute::Type::Number) {
            const std::uint32_t extent = attribute.components;
            const std::string_view meaning = attribute.isColour ? "rgb" : extent == 2 ? "vector" : "";
            out.array(attribute.name, AlembicType::Float, extent, std::as_bytes(part.numbers(attribute)),
                      parameter(scope, "float32_t", extent, 1, meaning));
        } else if (attribute.name == "groom_guide") {
            // As Unreal has it.
            const std::vector<std::int16_t> flags(whole.begin(), whole.end());
            out.array(attribute.name, AlembicType::Int16, 1, bytesOf(flags), parameter(scope, "int16_t"));
        } else if (attribute.type == ExportedAttribute::Type::Flag) {
            const std::vector<std::uint8_t> flags(whole.begin(), whole.end());
            out.array(attribute.name, AlembicType::Uint8, 1, bytesOf(flags), parameter(scope, "uint8_t"));
        } else {
            out.array(attribute.name, AlembicType::Int32, 1, std::as_bytes(whole),
                      parameter(scope, "int32_t"));
        }
    }

    /// What Unreal's schema keeps as three whole numbers is three attributes of Hairloom.
    static std::optional<std::size_t> closestGuidesIndex(std::string_view name) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (name == fmt::format("groom_closest_guides_{}", k)) return k;
        }
        return std::nullopt;
    }

    static void addClosestGuides(AlembicCompound& out,
                                 const std::array<const ExportedAttribute*, 3>& guides) {
        const auto isThere = [](const ExportedAttribute* guide) {
            return guide != nullptr && !guide->whole.empty();
        };
        if (!std::ranges::all_of(guides, isThere)) return;
        std::vector<std::int32_t> numbers;
        for (std::size_t strand = 0; strand < guides[0]->whole.size(); ++strand) {
            for (const ExportedAttribute* guide : guides) numbers.push_back(guide->whole[strand]);
        }
        out.array("groom_closest_guides", AlembicType::Int32, 1, bytesOf(numbers),
                  parameter("uni", "int32_t", 1, 3));
    }

    const PreparedStrands& strands_;
    std::vector<ExportedAttribute> attributes_;
    std::vector<ExportedPart> parts_;
    std::vector<std::string> groupNames_;  ///< of all strands, or none; Unreal's
    const StrandFrames* frames_;
    const WorkWatch& watch_;
    bool unreal_;
    AlembicTimes times_;
    OgawaBuilder file_;
    std::vector<std::string> metadata_;
};

}  // namespace

Result<ExportReport> writeAlembic(const Groom& groom, const std::filesystem::path& path,
                                  const StrandExportOptions& options, bool unreal) {
    // Unreal tells groups apart by attributes.
    auto strands = prepareStrands(groom, options, options.pointsPerStrand,
                                  unreal ? StrandOrder::groom : StrandOrder::layers);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    CurvesWriter writer(groom, *strands, options, unreal);
    auto bytes = writer.write();
    std::error_code code;
    const auto type = std::filesystem::status(path, code).type();
    const std::filesystem::path script = unrealScriptPath(path);
    // What goes into a device has nothing beside it.
    const bool hasScript =
        unreal && script != path &&
        (type == std::filesystem::file_type::regular || type == std::filesystem::file_type::not_found);
    const std::string text =
        hasScript ? unrealScript(groom, *strands, writer.attributes(), options, path) : std::string();
    auto report = writeAndCompare(groom, std::move(*strands), options, path, std::move(bytes));
    if (!report || !hasScript) return report;
    if (auto status = writeFileAtomically(script, std::string_view(text)); !status)
        return tl::unexpected(status.error());
    report->companions.push_back(script.filename().string());
    return report;
}

}  // namespace hairloom
