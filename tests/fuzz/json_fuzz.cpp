// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entries for JSON: FUZZED_JSON names what it says. What is read of a script and of a stack is
// run on three strands.

#include <cstdlib>
#include <string_view>

#include "core/documents/keyed_motion.h"
#include "core/groom/file/card_edits_json.h"
#include "core/groom/file/layers_json.h"
#include "core/groom/file/settings_json.h"
#include "core/operations/script.h"
#include "core/operations/stack.h"
#include "core/operations/stack_file.h"
#include "tests/fuzz/file_of_bytes.h"

namespace {

using namespace hairloom;

Groom sample() {
    std::vector<Vec3f> points;
    for (int p = 0; p < 12; ++p)
        points.emplace_back(0.01f * static_cast<float>(p / 4), 0.02f * static_cast<float>(p % 4), 0.0f);
    return makeGroom({0, 4, 8, 12}, std::move(points));
}

template <class T>
void mustSayWhy(const Result<T>& result) {
    if (!result && result.error().problem.empty()) std::abort();
}

void readObject(std::string_view text, void (*read)(JsonReader&)) {
    const auto json = parseJson("fuzzed", text);
    mustSayWhy(json);
    if (!json) return;
    JsonReader reader(*json, "fuzzed");
    read(reader);
    reader.finish();
    mustSayWhy(reader.status());
}

void script(std::string_view text) {
    const auto parsed = parseScript("fuzzed", text);
    mustSayWhy(parsed);
    if (!parsed || parsed->steps.size() > 4) return;
    Groom groom = sample();
    mustSayWhy(runScript(*parsed, groom));
}

void stack(std::string_view text) {
    const auto parsed = parseOperators("fuzzed", text);
    mustSayWhy(parsed);
}

void settings(std::string_view text) {
    readObject(text, [](JsonReader& reader) {
        HairMaterial material;
        InterpolationSettings interpolation;
        runtime::SimulationSettings simulation;
        if (reader.has("simulation")) readSettings(reader.object("simulation"), simulation);
        if (reader.has("material")) readSettings(reader.object("material"), material);
        if (reader.has("interpolation")) readSettings(reader.object("interpolation"), interpolation);
        if (reader.has("layers")) readLayers(reader);
        if (reader.has("spheres")) readSphereList(reader);
    });
}

void cards(std::string_view text) {
    readObject(text, [](JsonReader& reader) { readCardEdits(reader); });
}

void motion(std::string_view text) {
    const FileOfBytes file(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    mustSayWhy(readKeyedMotion(file.path().string()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FUZZED_JSON({reinterpret_cast<const char*>(data), size});
    return 0;
}
