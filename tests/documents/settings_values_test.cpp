// SPDX-License-Identifier: GPL-3.0-or-later
// No field of the settings takes what is no value of it.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/documents/open.h"
#include "core/groom/file/json_reader.h"

namespace hairloom {
namespace {

using Json = nlohmann::json;

template <class Settings>
void expectRefused(const char* section) {
    // What the command line makes of nan, 0,nan,0, 1e999, nothing and the like: text, where it is no JSON.
    const std::vector<Json> wrong{"nan",
                                  "inf",
                                  "0,nan,0",
                                  "1e999",
                                  "",
                                  "1;2",
                                  Json::array({0, nullptr, 0}),
                                  Json::array(),
                                  Json(),
                                  Json::object(),
                                  Json::array({0, 0, 0, 0, 0, "x"}),
                                  Json::array({Json::array({0, "nan"}), Json::array({1, 1})})};
    for (const FieldRow& row : fieldRows<Settings>()) {
        for (const Json& value : wrong) {
            Groom groom;
            Json document;
            document[section][std::string(row.info.name)] = value;
            EXPECT_FALSE(applySettings(document, "", groom))
                << section << '.' << row.info.name << '=' << value;
        }
    }
}

TEST(SettingsValues, WhatIsNoNumberIsRefusedForEveryField) {
    expectRefused<runtime::SimulationSettings>("simulation");
    expectRefused<HairMaterial>("material");
    expectRefused<ShadowSettings>("shadows");
    expectRefused<InterpolationSettings>("interpolation");
}

}  // namespace
}  // namespace hairloom
