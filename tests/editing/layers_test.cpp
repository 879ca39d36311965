// SPDX-License-Identifier: GPL-3.0-or-later
// Layers: strands that move between them, operators that act on one, layers that go.
#include <gmock/gmock.h>

#include "core/editing/layer_commands.h"
#include "core/editing/replay.h"
#include "core/editing/settings_commands.h"
#include "core/editing/stack_commands.h"
#include "core/groom/strand_subset.h"
#include "core/operations/stack.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

using testing::Each;
using testing::HasSubstr;

struct Layers : testing::Test {
    Layers() {
        for (const char* const name : {"Fringe", "Flyaways"}) {
            std::vector<Layer> layers = groom().layers;
            layers.push_back({name, true, false, 1, {}});
            document.perform(setLayers(document.model(), layers));
        }
        for (std::uint32_t s = 0; s < groom().strandCount(); s += 3) fringe.push_back(s);
        perform(moveToLayer(document.model(), fringe, 1));
    }
    void perform(Result<std::unique_ptr<Command>> command) {
        ASSERT_TRUE(command) << command.error().message();
        document.perform(std::move(*command));
    }
    void addNoiseOf(std::uint32_t layer) {
        nlohmann::json json{{"op", "noise"}, {"region", {{"layer", layer}}}};
        JsonReader reader(json, "o.json");
        perform(addOperator(document.model(), groom().operators.size(), readOperator(reader)));
    }
    const Groom& groom() const { return document.groom(); }
    std::vector<std::uint32_t> moved() const {
        const Groom before = hairOnHead();
        std::vector<std::uint32_t> strands;
        for (std::uint32_t s = 0; s < before.strandCount(); ++s) {
            if (!std::ranges::equal(before.strand(s), groom().strand(s))) strands.push_back(s);
        }
        return strands;
    }
    void expectHistoryAndScriptHold() {
        expectScriptMakesTheSame(document);
        const std::uint64_t made = contentHash(groom());
        while (document.undo()) continue;
        EXPECT_EQ(contentHash(groom()), contentHash(hairOnHead()));
        while (document.redo()) continue;
        EXPECT_EQ(contentHash(groom()), made);
    }

    Document document{hairOnHead()};
    std::vector<std::uint32_t> fringe;
};

TEST_F(Layers, StrandsAreOnTheLayerTheyMovedTo) {
    EXPECT_EQ(strandsOfLayer(groom(), 1), fringe);
    EXPECT_EQ(strandsOfLayer(groom(), 0).size() + fringe.size(), groom().strandCount());
    EXPECT_TRUE(strandsOfLayer(groom(), 2).empty());
    EXPECT_EQ(*moveToLayer(document.model(), fringe, 1), nullptr) << "they are there";
    EXPECT_FALSE(moveToLayer(document.model(), fringe, 3)) << "no such layer";
    expectHistoryAndScriptHold();
}

TEST_F(Layers, AnOperatorOfALayerMovesItsStrandsAlone) {
    addNoiseOf(2);
    EXPECT_EQ(moved(), fringe);
    // It goes with the strands.
    const std::vector<std::uint32_t> one{fringe.front()};
    perform(moveToLayer(document.model(), one, 2));
    EXPECT_EQ(moved(), std::vector(fringe.begin() + 1, fringe.end()));
    expectHistoryAndScriptHold();
}

TEST_F(Layers, ALayerThatGoesLeavesItsStrandsAndRenumbersOperators) {
    addNoiseOf(3);
    const auto refused = removeLayer(document.model(), 2);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("operator 0 uses the layer Flyaways"));
    perform(removeLayer(document.model(), 1));
    EXPECT_EQ(groom().layers.size(), 2u);
    EXPECT_EQ(groom().layers[1].name, "Flyaways");
    EXPECT_EQ(layerOf(groom().operators[0]), 2u);
    EXPECT_EQ(strandsOfLayer(groom(), 0).size(), groom().strandCount());
    expectHistoryAndScriptHold();
    Document single(hairOnHead());
    EXPECT_FALSE(removeLayer(single.model(), 0)) << "the only one";
}

TEST_F(Layers, HairOfLayersIsTheirsWithAllItsAttributes) {
    const std::vector<std::string> names{"Fringe"};
    const auto found = strandsOfLayers(groom(), names);
    ASSERT_TRUE(found) << found.error().message();
    ASSERT_EQ(*found, fringe);
    const Groom some = strandsOf(groom(), *found);
    ASSERT_EQ(some.strandCount(), fringe.size());
    for (std::size_t s = 0; s < fringe.size(); ++s)
        EXPECT_TRUE(std::ranges::equal(some.strand(s), groom().strand(fringe[s])));
    EXPECT_THAT(some.strandAttributes.view<std::uint32_t>(attribute::kLayer), Each(1u));
    EXPECT_EQ(some.rootBindings().size(), fringe.size());
    const std::vector<std::string> unknown{"Beard"};
    const auto refused = strandsOfLayers(groom(), unknown);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("Hair, Fringe, Flyaways"));
}

}  // namespace
}  // namespace hairloom::editing
