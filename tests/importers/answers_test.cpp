// SPDX-License-Identifier: GPL-3.0-or-later
// What the reader's process says of strands and pictures, whole and damaged.

#include <gmock/gmock.h>

#include "importers/picture_stream.h"
#include "importers/raw_strands_stream.h"
#include "importers/strand_file.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

RawStrands everything() {
    RawStrands raw;
    raw.format = "a format";
    raw.offsets = {0, 2, 5};
    raw.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}};
    raw.thickness = {1, 2, 3, 4, 5};
    raw.rootUvs = {{0.25f, 0.5f}, {0.75f, 1}};
    raw.sourceIndices = {4, 7};
    raw.defaultColour = Vec3f(0.1f, 0.2f, 0.3f);
    raw.mirrorZ = true;
    RawAttribute weights{"weights", true, RawAttribute::Type::Number, 2, {}, {}, {{1, 3}}};
    weights.numbers.assign(10, 0.5f);
    raw.attributes = {weights, {"group", false, RawAttribute::Type::Index, 1, {}, {1, 0}, {}}};
    raw.groupNames = {"fringe", "crown"};
    raw.parts = {{"/a", "A"}, {"/b", ""}};
    raw.partOfStrand = {1, 0};
    raw.frames = {raw.positions, raw.positions};
    raw.framesPerSecond = 24;
    raw.statedMetresPerUnit = 0.01f;
    raw.statedUp = UpAxis::Z;
    raw.ribbons = RibbonsFound{RibbonOrder::Around, 2, 3, 4, 5};
    raw.dropped = {{9, DropReason::Branches}};
    raw.warnings = {{Severity::Error, "what", "where", "fix"}};
    auto authored = std::make_shared<Groom>();
    authored->simulation.windSpeed = 3.25f;
    authored->material.rootRadius = 5e-5f;
    authored->layers.resize(2);
    authored->layers[0].name = "base";
    authored->layers[1].name = "top";
    authored->spheres = {{"skull", Vec3f(0, 1.5f, 0), 0.1f, "head"}};
    raw.authored = authored;
    return raw;
}

template <class Content, class Write>
std::vector<std::byte> answerOf(const Content& content, Write write) {
    std::vector<std::byte> bytes;
    write(content, "files (none)",
          [&](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
    return bytes;
}

std::vector<std::byte> strandsAnswer(const Result<RawStrands>& strands) {
    return answerOf(strands, writeRawStrands);
}

TEST(RawStrandsStream, ReadsBackWhatWasWritten) {
    const RawStrands raw = everything();
    std::string lacking;
    const auto back = readRawStrands("x.abc", strandsAnswer(raw), lacking);
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(lacking, "files (none)");
    EXPECT_EQ(back->offsets, raw.offsets);
    EXPECT_EQ(back->positions, raw.positions);
    EXPECT_EQ(back->rootUvs, raw.rootUvs);
    EXPECT_EQ(back->defaultColour, raw.defaultColour);
    EXPECT_TRUE(back->mirrorZ && back->rootFirst && !back->isResampled);
    EXPECT_EQ(back->attributes[0].numbers, raw.attributes[0].numbers);
    EXPECT_EQ(back->attributes[0].absent, raw.attributes[0].absent);
    EXPECT_EQ(back->attributes[1].type, RawAttribute::Type::Index);
    EXPECT_EQ(back->parts[0].name, "A");
    EXPECT_EQ(back->frames, raw.frames);
    EXPECT_EQ(back->statedUp, UpAxis::Z);
    EXPECT_EQ(back->assumedMetresPerUnit, std::nullopt);
    EXPECT_EQ(back->ribbons->mostSegments, 5u);
    EXPECT_EQ(back->dropped[0].reason, DropReason::Branches);
    EXPECT_EQ(back->warnings[0].fix, "fix");
    EXPECT_EQ(back->authored->simulation.windSpeed, 3.25f);
    EXPECT_EQ(back->authored->material.rootRadius, 5e-5f);
    EXPECT_EQ(back->authored->layers[1].name, "top");
    EXPECT_EQ(back->authored->spheres[0].bone, "head");
    const auto error =
        readRawStrands("x.abc", strandsAnswer(failIn("y.usd", Byte{7}, "broken", "whole")), lacking);
    ASSERT_FALSE(error);
    EXPECT_EQ(error.error().message(), "y.usd@7: broken; whole");
}

TEST(RawStrandsStream, EveryTruncationAndEveryDamagedByteIsHandled) {
    const std::vector<std::byte> bytes = strandsAnswer(everything());
    std::string lacking;
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(readRawStrands("x.abc", std::span(bytes).first(length), lacking)) << length;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        for (const std::byte flip : {std::byte{0xff}, std::byte{1}}) {
            std::vector<std::byte> damaged = bytes;
            damaged[at] ^= flip;
            const auto strands = readRawStrands("x.abc", damaged, lacking);
            EXPECT_TRUE(!strands || checkRawStrands(*strands)) << at;
        }
    }
}

TEST(RawStrandsStream, WhatDoesNotFitIsRefused) {
    const auto problem = [](const auto& damage) {
        RawStrands raw = everything();
        damage(raw);
        std::string lacking;
        const auto strands = readRawStrands("x.abc", strandsAnswer(raw), lacking);
        return strands ? std::string() : strands.error().message();
    };
    EXPECT_EQ(problem([](RawStrands&) {}), "");
    EXPECT_THAT(problem([](RawStrands& raw) { raw.offsets.back() = 6; }), HasSubstr("do not fit"));
    EXPECT_THAT(problem([](RawStrands& raw) { raw.offsets[1] = 7; }), HasSubstr("do not fit"));
    EXPECT_THAT(problem([](RawStrands& raw) { raw.thickness.pop_back(); }), HasSubstr("values of points"));
    EXPECT_THAT(problem([](RawStrands& raw) { raw.rootUvs.pop_back(); }), HasSubstr("values of strands"));
    EXPECT_THAT(problem([](RawStrands& raw) { raw.partOfStrand[0] = 2; }), HasSubstr("part"));
    EXPECT_THAT(problem([](RawStrands& raw) { raw.frames[1].pop_back(); }), HasSubstr("frame"));
    EXPECT_THAT(problem([](RawStrands& raw) { raw.attributes[0].numbers.pop_back(); }), HasSubstr("weights"));
    EXPECT_THAT(problem([](RawStrands& raw) { raw.attributes[0].absent = {{4, 6}}; }), HasSubstr("weights"));
}

TEST(PictureStream, ReadsBackWhatWasWrittenAndNothingElse) {
    const render::LinearImage picture{2, 1, {0, 0.25f, 0.5f, 1, 2, 3, 4, 0}};
    const auto bytes = answerOf(Result<render::LinearImage>(picture), writePicture);
    std::string lacking;
    const auto back = readPictureAnswer("x.png", bytes, lacking);
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(back->rgba, picture.rgba);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(readPictureAnswer("x.png", std::span(bytes).first(length), lacking)) << length;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::vector<std::byte> damaged = bytes;
        damaged[at] ^= std::byte{1};
        const auto read = readPictureAnswer("x.png", damaged, lacking);
        EXPECT_TRUE(!read || read->rgba.size() == std::size_t{4} * read->width * read->height) << at;
    }
}

TEST(StrandFile, WordsSayTheOptionsAgain) {
    StrandImportOptions options;
    options.metresPerUnit = 0.0123f;
    options.isUnitAsked = options.frames = true;
    options.framesPerSecond = 29.97f;
    options.ribbonOrder = RibbonOrder::Around;
    options.ribbonParticle = RibbonParticle::Centre;
    options.ribbonSegments = 17;
    options.pointsPerStrand = 5;
    StrandImportOptions back;
    for (const std::string& word : wordsOf(options)) EXPECT_TRUE(takeWord(word, back)) << word;
    EXPECT_EQ(back.metresPerUnit, options.metresPerUnit);
    EXPECT_TRUE(back.isUnitAsked && back.frames);
    EXPECT_EQ(back.framesPerSecond, options.framesPerSecond);
    EXPECT_EQ(back.ribbonOrder, options.ribbonOrder);
    EXPECT_EQ(back.ribbonParticle, options.ribbonParticle);
    EXPECT_EQ(back.ribbonSegments, 17u);
    EXPECT_EQ(back.pointsPerStrand, 5u);
    for (const char* word : {"", "--", "--unit", "--unit=x", "--order=9", "--order=-1", "--points=5x", "-o"})
        EXPECT_FALSE(takeWord(word, back)) << word;
}

}  // namespace
}  // namespace hairloom
