// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/versions.h"

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <array>
#include <map>

#include "core/base/versioned_name.h"
#include "core/base/write_rules.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

struct OutputName {
    const char* option;
    const char* job;  ///< null: of all
};
constexpr std::array kOutputNames{
    OutputName{"--output", nullptr},         OutputName{"--exr", "render"},
    OutputName{"--animation", "render"},     OutputName{"--strip", "render"},
    OutputName{"--record", "simulate"},      OutputName{"--record", "import"},
    OutputName{"--keep", "stack"},           OutputName{"--keep", "timeline"},
    OutputName{"--keep-motion", "timeline"}, OutputName{"--markdown", "bench"},
    OutputName{"--man", "reference"},        OutputName{"--readme", "reference"},
    OutputName{"--jobs", "reference"},       OutputName{"--openjd", "sweep"}};

/// By the path with its token.
std::map<std::string, unsigned>& taken() {
    static std::map<std::string, unsigned> instance;
    return instance;
}

}  // namespace

std::vector<CLI::Option*> outputOptions(CLI::App& job) {
    std::vector<CLI::Option*> options;
    for (const OutputName& name : kOutputNames) {
        if (name.job != nullptr && name.job != job.get_name()) continue;
        if (CLI::Option* const option = job.get_option_no_throw(name.option)) options.push_back(option);
    }
    return options;
}

void takeVersions(CLI::App& job) {
    for (CLI::Option* const option : outputOptions(job)) {
        const auto take = [&job](std::string& value) {
            if (!hasVersionToken(value)) return std::string();
            // The first output looks at all of them, whose names are as they were typed then.
            unsigned version = taken().empty() ? 0 : taken().begin()->second;
            if (version == 0)
                for (const CLI::Option* const other : outputOptions(job))
                    for (const std::string& path : other->results())
                        if (hasVersionToken(path)) version = std::max(version, nextVersion(path));
            taken()[value] = version;
            value = withVersion(value, version).string();
            return std::string();
        };
        option->transform(CLI::Validator(take, "", ""));
    }
}

bool isVersioned(const std::string& output) {
    return std::ranges::any_of(
        taken(), [&](const auto& one) { return withVersion(one.first, one.second).string() == output; });
}

std::vector<std::string> keepVersions() {
    std::vector<std::string> outputs;
    for (const auto& [path, version] : taken()) {
        outputs.push_back(withVersion(path, version).string());
        keepNew(versionBeginning(path, version));
    }
    return outputs;
}

}  // namespace hairloom::cli
