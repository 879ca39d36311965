// SPDX-License-Identifier: GPL-3.0-or-later
// Binary USD: the same curves and attributes as in text.

#include "core/groom/file/json_reader.h"
#include "exporters/usd_curves.h"
#include "exporters/usd_scene.h"
#include "exporters/usdc_builder.h"
#include "importers/authored_settings.h"

namespace hairloom {
namespace {

UsdcRep valueOf(UsdcBuilder& file, const ExportedPart& part, const ExportedAttribute& attribute,
                std::string_view type) {
    if (attribute.type == ExportedAttribute::Type::Number)
        return file.floats(part.numbers(attribute), attribute.components);
    const auto whole = part.wholes(attribute);
    if (type == "int") return file.ints(whole);
    const std::vector<std::uint8_t> bytes(whole.begin(), whole.end());
    return file.bytes(bytes, type == "bool");
}

std::span<const float> numbersOf(std::span<const Vec3f> values) {
    return {values[0].data(), values.size() * 3};
}

void writeRoot(UsdcBuilder& file, const StrandExportOptions& options) {
    const std::vector<std::string> top{"groom"};
    UsdcBuilder::Fields head{{"defaultPrim", file.token("groom")},
                             {"metersPerUnit", file.number(readableDecimal(options.metresPerUnit))},
                             {"upAxis", file.token(options.up == UpAxis::Z ? "Z" : "Y")},
                             {"primChildren", file.tokens(top)}};
    if (options.frames) {
        const double first = options.frames->first, rate = options.frames->framesPerSecond;
        head.emplace_back("startTimeCode", file.number(first));
        head.emplace_back("endTimeCode",
                          file.number(first + static_cast<double>(options.frames->frameCount() - 1)));
        head.emplace_back("framesPerSecond", file.number(rate));
        head.emplace_back("timeCodesPerSecond", file.number(rate));
    }
    file.root(head);
}

void addNames(const UsdNode& node, std::vector<std::string>& names) {
    for (const auto& [name, path] : node.targets) names.push_back(name);
    for (const UsdField& field : node.fields) names.push_back(field.name);
}

UsdcRep valueOf(UsdcBuilder& file, const UsdField& field) {
    if (const auto* number = std::get_if<float>(&field.value)) return file.single(*number);
    if (const auto* vector = std::get_if<Vec3f>(&field.value)) return file.vector({vector->data(), 3});
    if (const auto* text = std::get_if<std::string>(&field.value)) return file.token(*text);
    if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&field.value)) return file.ints(*whole);
    const auto& vectors = std::get<std::vector<Vec3f>>(field.value);
    return file.floats(vectors.empty() ? std::span<const float>() : numbersOf(vectors), 3);
}

void writeFields(UsdcBuilder& file, const UsdNode& node, std::uint32_t depth) {
    for (const auto& [name, path] : node.targets)
        file.relationship(depth, name, {{"variability", file.uniform()}, {"targetPaths", file.path(path)}});
    for (const UsdField& field : node.fields) {
        UsdcBuilder::Fields fields{{"typeName", file.token(field.type)}};
        if (field.isUniform) fields.emplace_back("variability", file.uniform());
        if (!field.interpolation.empty())
            fields.emplace_back("interpolation", file.token(field.interpolation));
        fields.emplace_back("default", valueOf(file, field));
        file.attribute(depth, field.name, fields);
    }
}

void writeNode(UsdcBuilder& file, const UsdNode& node, std::uint32_t depth) {
    std::vector<std::string> children, names;
    for (const UsdNode& child : node.children) children.push_back(child.name);
    addNames(node, names);
    UsdcBuilder::Fields fields{{"specifier", file.definition()}, {"typeName", file.token(node.type)}};
    if (!node.schemas.empty()) fields.emplace_back("apiSchemas", file.prepended(node.schemas));
    if (!children.empty()) fields.emplace_back("primChildren", file.tokens(children));
    if (!names.empty()) fields.emplace_back("properties", file.tokens(names));
    file.prim(depth, node.name, fields);
    for (const UsdNode& child : node.children) writeNode(file, child, depth + 1);
    writeFields(file, node, depth + 1);
}

class PartWriter {
  public:
    PartWriter(UsdcBuilder& file, const PreparedStrands& strands, const StrandExportOptions& options)
        : file_(file), strands_(strands), watch_(options.watch) {
        if (!options.frames) return;
        frames_ = options.frames.get();
        for (std::size_t f = 0; f < strands.frames.size(); ++f) times_.push_back(frames_->numberOf(f));
    }

    void write(const ExportedPart& part, std::span<const ExportedAttribute> attributes,
               const UsdMaterial& material, const UsdNode& more) {
        std::vector<std::string> names{"material:binding",  "type",   "wrap",  "extent",
                                       "curveVertexCounts", "points", "widths"};
        addNames(more, names);
        if (strands_.frames.size() > 1) names.emplace_back("velocities");
        for (const ExportedAttribute& attribute : attributes) names.push_back("primvars:" + attribute.name);
        UsdcBuilder::Fields fields{{"specifier", file_.definition()},
                                   {"typeName", file_.token("BasisCurves")},
                                   {"properties", file_.tokens(names)}};
        if (!part.displayName.empty()) fields.emplace_back("displayName", file_.string(part.displayName));
        std::vector<std::string> schemas{"MaterialBindingAPI"};
        schemas.insert(schemas.end(), more.schemas.begin(), more.schemas.end());
        fields.emplace_back("apiSchemas", file_.prepended(schemas));
        file_.prim(2, part.name, fields);
        file_.relationship(3, "material:binding",
                           {{"variability", file_.uniform()}, {"targetPaths", file_.path(material.path)}});
        writeFields(file_, more, 3);
        for (const auto& [name, value] : {std::pair("type", "linear"), std::pair("wrap", "nonperiodic")})
            file_.attribute(3, name,
                            {{"typeName", file_.token("token")},
                             {"variability", file_.uniform()},
                             {"default", file_.token(value)}});
        writePoints(part);
        file_.attribute(3, "widths",
                        {{"typeName", file_.token("float[]")},
                         {"interpolation", file_.token("vertex")},
                         {"default", file_.floats(part.widths(strands_), 1)}});
        writeVelocities(part);
        for (const ExportedAttribute& attribute : attributes) writeAttribute(part, attribute);
    }

  private:
    void writePoints(const ExportedPart& part) {
        const auto add = [&](const std::string& name, const char* type, UsdcRep value,
                             std::span<const UsdcRep> frames = {}) {
            UsdcBuilder::Fields fields{{"typeName", file_.token(type)}, {"default", value}};
            if (!frames.empty()) fields.emplace_back("timeSamples", file_.samples(times_, frames));
            file_.attribute(3, name, fields);
        };
        const auto box = [&](std::span<const Vec3f> all) {
            const std::array<Vec3f, 2> extent = part.extent(strands_, all);
            return file_.floats({extent[0].data(), 6}, 3);
        };
        const auto points = [&](std::span<const Vec3f> all) {
            return file_.floats(numbersOf(part.points(all)), 3);
        };
        std::vector<UsdcRep> extents, shapes;
        for (const std::vector<Vec3f>& frame : strands_.frames) {
            if (watch_.isCancelled()) return;
            extents.push_back(box(frame));
            shapes.push_back(points(frame));
        }
        add("extent", "float3[]", box(strands_.positions), extents);
        add("curveVertexCounts", "int[]", file_.ints(part.vertexCounts(strands_)));
        add("points", "point3f[]", points(strands_.positions), shapes);
    }

    void writeVelocities(const ExportedPart& part) {
        std::vector<std::span<const Vec3f>> shapes;
        for (const std::vector<Vec3f>& frame : strands_.frames) shapes.push_back(part.points(frame));
        if (shapes.size() < 2) return;
        std::vector<UsdcRep> values;
        for (std::size_t f = 0; f < shapes.size(); ++f) {
            if (watch_.isCancelled()) return;
            values.push_back(file_.floats(numbersOf(pointVelocities(shapes, f, *frames_)), 3));
        }
        file_.attribute(
            3, "velocities",
            {{"typeName", file_.token("vector3f[]")}, {"timeSamples", file_.samples(times_, values)}});
    }

    void writeAttribute(const ExportedPart& part, const ExportedAttribute& attribute) {
        const std::string type(usdTypeOf(attribute));
        UsdcBuilder::Fields fields{{"typeName", file_.token(type + "[]")},
                                   {"interpolation", file_.token(attribute.perPoint ? "vertex" : "uniform")},
                                   {"default", valueOf(file_, part, attribute, type)}};
        if (!attribute.original.empty()) fields.emplace_back("displayName", file_.string(attribute.original));
        file_.attribute(3, "primvars:" + attribute.name, fields);
    }

    UsdcBuilder& file_;
    const PreparedStrands& strands_;
    std::vector<double> times_;
    const StrandFrames* frames_ = nullptr;
    const WorkWatch& watch_;
};

UsdcRep valueOf(UsdcBuilder& file, const UsdShaderInput& input) {
    if (!input.numbers.empty())
        return input.numbers.size() == 1 ? file.single(input.numbers[0]) : file.vector(input.numbers);
    return input.type == "token" ? file.token(input.text) : file.string(input.text);
}

void writeShader(UsdcBuilder& file, const UsdShader& shader) {
    std::vector<std::string> names{"info:id"};
    for (const UsdShaderInput& input : shader.inputs) names.push_back("inputs:" + input.name);
    for (const auto& [type, name] : shader.outputs) names.push_back("outputs:" + name);
    file.prim(4, shader.name,
              {{"specifier", file.definition()},
               {"typeName", file.token("Shader")},
               {"properties", file.tokens(names)}});
    file.attribute(5, "info:id",
                   {{"typeName", file.token("token")},
                    {"variability", file.uniform()},
                    {"default", file.token(shader.id)}});
    for (const UsdShaderInput& input : shader.inputs) {
        UsdcBuilder::Fields fields{{"typeName", file.token(input.type)}};
        if (input.connection.empty())
            fields.emplace_back("default", valueOf(file, input));
        else
            fields.emplace_back("connectionPaths", file.path(input.connection));
        file.attribute(5, "inputs:" + input.name, fields);
    }
    for (const auto& [type, name] : shader.outputs)
        file.attribute(5, "outputs:" + name, {{"typeName", file.token(type)}});
}

void writeMaterials(UsdcBuilder& file, const std::string& folder, const UsdMaterials& materials) {
    std::vector<std::string> names;
    for (const UsdMaterial& material : materials.all) names.push_back(material.name);
    file.prim(2, folder,
              {{"specifier", file.definition()},
               {"typeName", file.token("Scope")},
               {"primChildren", file.tokens(names)}});
    for (const UsdMaterial& material : materials.all) {
        std::vector<std::string> shaders;
        for (const UsdShader& shader : material.shaders) shaders.push_back(shader.name);
        const std::vector<std::string> outputs{"outputs:surface", "outputs:mtlx:surface"};
        file.prim(3, material.name,
                  {{"specifier", file.definition()},
                   {"typeName", file.token("Material")},
                   {"primChildren", file.tokens(shaders)},
                   {"properties", file.tokens(outputs)}});
        for (const UsdShader& shader : material.shaders) writeShader(file, shader);
        file.attribute(4, outputs[0],
                       {{"typeName", file.token("token")}, {"connectionPaths", file.path(material.preview)}});
        file.attribute(4, outputs[1],
                       {{"typeName", file.token("token")}, {"connectionPaths", file.path(material.surface)}});
    }
}

void writeScalp(UsdcBuilder& file, const std::string& name, const UsdScalp& scalp) {
    std::vector<std::string> names{"subdivisionScheme", "doubleSided", "extent", "faceVertexCounts",
                                   "faceVertexIndices", "points",      "normals"};
    if (!scalp.uvs.empty()) names.emplace_back("primvars:st");
    file.prim(2, name,
              {{"specifier", file.definition()},
               {"typeName", file.token("Mesh")},
               {"properties", file.tokens(names)}});
    const auto add = [&](const char* attribute, const char* type, UsdcRep value,
                         const char* interpolation = "") {
        UsdcBuilder::Fields fields{{"typeName", file.token(type)}, {"default", value}};
        if (*interpolation != '\0') fields.emplace_back("interpolation", file.token(interpolation));
        file.attribute(3, attribute, fields);
    };
    file.attribute(3, "subdivisionScheme",
                   {{"typeName", file.token("token")},
                    {"variability", file.uniform()},
                    {"default", file.token("none")}});
    file.attribute(
        3, "doubleSided",
        {{"typeName", file.token("bool")}, {"variability", file.uniform()}, {"default", file.boolean(true)}});
    const std::array<Vec3f, 2> extent = extentOf(scalp.points);
    add("extent", "float3[]", file.floats({extent[0].data(), 6}, 3));
    add("faceVertexCounts", "int[]", file.ints(scalp.faceVertexCounts));
    add("faceVertexIndices", "int[]", file.ints(scalp.faceVertexIndices));
    add("points", "point3f[]", file.floats(numbersOf(scalp.points), 3));
    add("normals", "normal3f[]", file.floats(numbersOf(scalp.normals), 3), "vertex");
    if (!scalp.uvs.empty()) add("primvars:st", "texCoord2f[]", file.floats(scalp.uvs, 2), "faceVarying");
}

Result<ExportReport> writeUsdc(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand, StrandOrder::layersAndGuides);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    const bool hasOperators = usdHasOperators(groom, options);
    const auto attributes = exportedAttributes(groom, *strands, usdNames(hasOperators));
    const std::vector<ExportedPart> parts = exportedParts(groom, *strands, isLegalInUsd);
    const UsdBeside beside = usdBeside(parts);
    const UsdMaterials materials = usdMaterials(groom, *strands, attributes, beside.materials);
    const UsdScalp scalp = usdScalp(groom, options);
    UsdcBuilder file;
    file.reserve(roomOf(*strands, attributes));
    writeRoot(file, options);
    std::vector<std::string> names;
    for (const ExportedPart& part : parts) names.push_back(part.name);
    if (!scalp.empty()) names.push_back(beside.scalp);
    names.push_back(beside.materials);
    const UsdMore more = usdMore(groom, *strands, options, parts, beside.physics);
    for (const UsdNode& node : more.beside) names.push_back(node.name);
    UsdcBuilder::Fields settings;
    for (const auto& [name, text] : usdSettings(groom, *strands, hasOperators))
        settings.emplace_back(name, file.string(text));
    const UsdcBuilder::Fields custom{{std::string(kUsdDictionary), file.dictionary(settings)}};
    file.prim(1, "groom",
              {{"specifier", file.definition()},
               {"typeName", file.token("Xform")},
               {"primChildren", file.tokens(names)},
               {"customData", file.dictionary(custom)}});
    PartWriter writer(file, *strands, options);
    for (std::size_t p = 0; p < parts.size(); ++p)
        writer.write(parts[p], attributes, materials.all[materials.ofPart[p]], more.ofParts[p]);
    if (!scalp.empty()) writeScalp(file, beside.scalp, scalp);
    writeMaterials(file, beside.materials, materials);
    for (const UsdNode& node : more.beside) writeNode(file, node, 2);
    return writeAndCompare(groom, std::move(*strands), options, path, file.finish());
}

}  // namespace

HairWriter usdcWriter() {
    HairWriter writer{"usdc", "USD .usdc",         "like usda, in a tenth of the time",
                      "none", usdTargets(".usdc"), writeUsdc};
    writer.animates = true;
    writer.keepsGuides = true;
    writer.holdsPhysics = true;
    return writer;
}

}  // namespace hairloom
