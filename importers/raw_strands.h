// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the readers of strand formats hand to importStrands: the file's own numbers, in its units and axes.

#include <memory>
#include <optional>

#include "importers/strands.h"

namespace hairloom {

/// Named values of strands or points, element after element.
struct RawAttribute {
    enum class Type : std::uint8_t { Number, Whole, Flag, Index };
    std::string name;
    bool perPoint = false;
    Type type = Type::Number;
    std::uint32_t components = 1;     ///< 1 … 4 of numbers, else 1
    std::vector<float> numbers;       ///< of Number
    std::vector<std::int32_t> whole;  ///< of the others
    /// Elements that the file has no value of, [first, second), ascending: those of parts without the
    /// attribute.
    std::vector<std::pair<std::size_t, std::size_t>> absent{};
};

/// An object or group of a file that strands come in (importers/strand_parts.h).
struct StrandPart {
    std::string path;  ///< "/groom/brows", in the file
    std::string name;  ///< what people call it, where the file says so
};

struct RawStrands {
    std::string format;
    std::vector<std::uint32_t> offsets{0};  ///< as in Groom
    std::vector<std::uint32_t>
        sourceIndices;                   ///< strand of the file of each strand; empty when they are the same
    std::vector<Vec3f> positions;        ///< units and axes of the file
    std::vector<float> thickness;        ///< per point, diameter in units of the file, or empty
    std::vector<float> transparency;     ///< per point, 0 … 1, or empty
    std::vector<Vec3f> colours;          ///< per point, linear RGB, or empty
    std::vector<Vec2f> rootUvs;          ///< per strand, or empty
    std::vector<float> thicknessScale;   ///< per strand, a factor without unit, or empty
    float defaultThickness = 0;          ///< diameter in units of the file for all points; 0 where unknown
    std::optional<Vec3f> defaultColour;  ///< linear RGB for all points
    bool rootFirst = true;               ///< false where the format does not say which end is the root
    bool mirrorZ = false;                ///< the file is left-handed by a negated Z
    std::vector<RawAttribute> attributes;  ///< what else the file has; no two of one name and domain
    std::vector<std::string> groupNames;   ///< of the attribute "group"
    /// Of an attribute "groom_group_name" of whole numbers, by these; 0 is none.
    std::vector<std::string> groupTexts{std::string()};
    std::vector<std::string> layerNames;  ///< of the attribute "layer", where the file has parts
    std::vector<StrandPart> parts;
    std::vector<std::uint32_t> partOfStrand;   ///< of all strands, or of none
    std::vector<std::vector<Vec3f>> frames;    ///< `positions` at each time where the strands move
    float framesPerSecond = 0;                 ///< of them
    bool isResampled = false;                  ///< they lie between the file's samples
    std::optional<float> statedMetresPerUnit;  ///< where the file says it; goes before the option
    /// What the format takes for the unit where the file does not say; the option goes before it, where one
    /// was asked for.
    std::optional<float> assumedMetresPerUnit;
    std::optional<UpAxis> statedUp;       ///< as well
    std::optional<RibbonsFound> ribbons;  ///< of hair written as polygons
    /// Settings, material, interpolation, spheres, layers and operators, of a file that has them; no strands.
    std::shared_ptr<const Groom> authored;
    std::uint64_t authoredShape = 0;     ///< hash of the positions that the operators of `authored` made
    std::vector<DroppedStrand> dropped;  ///< what the reader itself had to leave out
    std::vector<Finding> warnings;
};

/// A finding of the reader about the file.
inline Finding fileWarning(std::string what, std::string where, std::string fix) {
    return {Severity::Warning, std::move(what), std::move(where), std::move(fix)};
}
inline Finding fileNote(std::string what, std::string where, std::string fix = {}) {
    return {Severity::Info, std::move(what), std::move(where), std::move(fix)};
}

enum class Recognition : std::uint8_t {
    Signature,  ///< the file begins as no other format does, and holds strands alone
    Structure,  ///< told by the whole file, of which all is to be given; asked after those with a signature
    Guess,      ///< may be anything; asked last
};

/// A format that is read. One file NAME_reader.cpp of this folder: nameReader() says what it is.
struct StrandReader {
    FileFormat format;
    Recognition recognition;
    /// From the first 256 bytes or more where the format has a signature, else from all of them.
    bool (*recognise)(std::span<const std::byte> bytes);
    /// `file` is named in errors. The bytes are the reader's to let go once it has what it needs of them:
    /// beside a million strands they weigh.
    Result<RawStrands> (*read)(const std::string& file, std::vector<std::byte>&& bytes,
                               const StrandImportOptions& options);
    /// Suffix of a file that may lie beside it under its name; empty: none. What is wrong with that file is
    /// an error, and leaves the strands as they are.
    std::string_view companion = {};
    Status (*readCompanion)(const std::string& file, std::span<const std::byte> bytes,
                            RawStrands& strands) = nullptr;
};
const std::vector<StrandReader>& strandReaders();

/// What of an OBJ concerns strands. Indices are checked and count from 0.
struct ObjStrandText {
    std::vector<Vec3f> vertices;
    std::vector<std::uint32_t> lineOffsets{0};  ///< line k has lineIndices[lineOffsets[k] …)
    std::vector<std::uint32_t> lineIndices;
    std::vector<std::uint32_t> faceOffsets{0};
    std::vector<std::uint32_t> faceIndices;
    std::vector<std::uint64_t> faceLines;             ///< line of the file of each face, from 1
    std::vector<StrandPart> parts;                    ///< objects and groups that have lines or faces
    std::vector<std::uint32_t> lineParts, faceParts;  ///< of each line and face, or of none
    std::vector<Finding> warnings;
};
Result<ObjStrandText> parseObjStrands(const std::string& file, std::string_view text);

/// Ribbons of 2n vertices into strands of n particles (thesis §4.1; its "2n/n_v" strands are n_v/(2n)).
Result<RawStrands> strandsFromRibbons(const std::string& file, const ObjStrandText& obj,
                                      const StrandImportOptions& options);

/// Lines into strands; those of two points that share vertices are chained. `vertices` gets the vertex of
/// each point.
Result<RawStrands> strandsFromLines(const std::string& file, const ObjStrandText& obj,
                                    std::vector<std::uint32_t>& vertices);

}  // namespace hairloom
