// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/raw_strands_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "importers/authored_settings.h"

namespace hairloom {
namespace {

constexpr auto kStrandMembers = [](auto& archive, auto& raw) {
    archive(raw.format);
    archive(raw.offsets);
    archive(raw.sourceIndices);
    archive(raw.positions);
    archive(raw.thickness);
    archive(raw.transparency);
    archive(raw.colours);
    archive(raw.rootUvs);
    archive(raw.thicknessScale);
    archive(raw.defaultThickness);
    archive.maybe(raw.defaultColour, archive);
    archive(raw.rootFirst);
    archive(raw.mirrorZ);
    archive.each(raw.attributes, [&](auto& attribute) {
        archive(attribute.name);
        archive(attribute.perPoint);
        archive.choice(attribute.type, RawAttribute::Type::Index);
        archive(attribute.components);
        archive(attribute.numbers);
        archive(attribute.whole);
        archive.each(attribute.absent, [&](auto& range) {
            archive(range.first);
            archive(range.second);
        });
    });
    archive.each(raw.groupNames, archive);
    archive.each(raw.groupTexts, archive);
    archive.each(raw.layerNames, archive);
    archive.each(raw.parts, [&](auto& part) {
        archive(part.path);
        archive(part.name);
    });
    archive(raw.partOfStrand);
    archive.each(raw.frames, archive);
    archive(raw.framesPerSecond);
    archive(raw.isResampled);
    archive.maybe(raw.statedMetresPerUnit, archive);
    archive.maybe(raw.assumedMetresPerUnit, archive);
    archive.maybe(raw.statedUp, [&](auto& up) { archive.choice(up, UpAxis::Z); });
    archive.maybe(raw.ribbons, [&](auto& found) {
        archive.choice(found.order, RibbonOrder::Around);
        archive(found.fewestSides);
        archive(found.sides);
        archive(found.fewestSegments);
        archive(found.mostSegments);
    });
    archive(raw.authoredShape);
    archive.each(raw.dropped, [&](auto& dropped) {
        archive(dropped.strand);
        archive.choice(dropped.reason, DropReason::ClosedLoop);
    });
    archive.each(raw.warnings, [&](auto& finding) {
        archive.choice(finding.severity, Severity::Error);
        archive(finding.what);
        archive(finding.where);
        archive(finding.fix);
    });
};

/// Strands, and what a file authored of settings as the project file has them; empty: nothing.
struct Content {
    RawStrands strands;
    std::string authored;
};
constexpr auto kContentMembers = [](auto& archive, auto& content) {
    kStrandMembers(archive, content.strands);
    archive(content.authored);
};

/// One value for each of `count`, or none at all.
bool isOfAllOrNone(std::size_t size, std::size_t count) {
    return size == 0 || size == count;
}

Status checkAttribute(const RawAttribute& attribute, std::size_t count) {
    const bool isNumber = attribute.type == RawAttribute::Type::Number;
    const std::size_t components = isNumber ? attribute.components : 1;
    if (components < 1 || components > 4)
        return fail(fmt::format("the attribute {} has {} components", attribute.name, attribute.components));
    const std::size_t size = isNumber ? attribute.numbers.size() : attribute.whole.size();
    const std::size_t other = isNumber ? attribute.whole.size() : attribute.numbers.size();
    if (size != count * components || other != 0)
        return fail(fmt::format("the attribute {} has {} values of {}", attribute.name, size + other, count));
    for (const auto& [first, second] : attribute.absent) {
        if (first > second || second > count)
            return fail(fmt::format("the attribute {} is absent where nothing is", attribute.name));
    }
    return {};
}

}  // namespace

Status checkRawStrands(const RawStrands& raw) {
    if (raw.offsets.empty() || raw.offsets.front() != 0 || !std::ranges::is_sorted(raw.offsets) ||
        raw.offsets.back() != raw.positions.size())
        return fail("strands and points do not fit each other");
    const std::size_t points = raw.positions.size(), strands = raw.offsets.size() - 1;
    for (const std::size_t size : {raw.thickness.size(), raw.transparency.size(), raw.colours.size()}) {
        if (!isOfAllOrNone(size, points)) return fail("values of points are not one for each point");
    }
    for (const std::size_t size : {raw.rootUvs.size(), raw.thicknessScale.size(), raw.sourceIndices.size()}) {
        if (!isOfAllOrNone(size, strands)) return fail("values of strands are not one for each strand");
    }
    for (const RawAttribute& attribute : raw.attributes) {
        if (auto status = checkAttribute(attribute, attribute.perPoint ? points : strands); !status)
            return status;
    }
    const auto isPart = [&](std::uint32_t part) { return part < raw.parts.size(); };
    if (raw.partOfStrand.size() > strands || !std::ranges::all_of(raw.partOfStrand, isPart))
        return fail("a strand is of a part that is not there");
    for (const std::vector<Vec3f>& frame : raw.frames) {
        if (frame.size() != points) return fail("a frame has not all points");
    }
    return {};
}

void writeRawStrands(const Result<RawStrands>& strands, const std::string& lacking,
                     const AnswerWriter::Sink& sink) {
    const std::string authored = strands && strands->authored ? settingsText(*strands->authored) : "";
    writeAnswer(strands, AnswerKind::Strands, lacking, sink, [&](auto& archive, const RawStrands& raw) {
        kStrandMembers(archive, raw);
        archive(authored);
    });
}

Result<RawStrands> readRawStrands(const std::string& file, std::span<const std::byte> bytes,
                                  std::string& lacking) {
    auto content = readAnswer<Content>(file, bytes, AnswerKind::Strands, lacking, kContentMembers);
    if (!content) return tl::unexpected(content.error());
    RawStrands raw = std::move(content->strands);
    if (auto status = checkRawStrands(raw); !status) {
        return failIn(file, {}, "the reader's answer is invalid: " + status.error().problem,
                      "the file is damaged in a way that breaks the reader");
    }
    if (!content->authored.empty()) {
        auto authored = readSettingsText(file, content->authored);
        if (!authored) return tl::unexpected(authored.error());
        raw.authored = std::move(*authored);
    }
    return raw;
}

}  // namespace hairloom
