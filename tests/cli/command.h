// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs the command line program as a user would, in a folder of the test's own.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/temporary_folder.h"

namespace hairloom::test {

struct Outcome {
    int exitCode;
    std::string output;  ///< standard output
    std::string errors;  ///< standard error

    /// The one JSON object on standard output.
    nlohmann::json json() const { return nlohmann::json::parse(output); }
};

/// The sample head, for --mesh.
std::string bustFile();

class CommandLineTest : public testing::Test {
  protected:
    CommandLineTest();

    /// 300 strands on the bust, as hair.hairloom.
    std::string createArguments(const std::string& more = "", int seed = 7, int points = 12) const {
        return "create --mesh '" + bustFile() + "' --scalp material:scalp --count 300 --placement dart" +
               " --length 0.2 --points " + std::to_string(points) + " --seed " + std::to_string(seed) +
               " -o hair.hairloom " + more;
    }
    /// Runs `hairloom-cli ARGUMENTS` through the shell with the test's folder as the working one.
    Outcome run(const std::string& arguments) const;
    /// As run, with --json, and a failure of the test when the job fails.
    nlohmann::json runJson(const std::string& arguments) const;

  private:
    const TemporaryFolder own_;

  protected:
    const std::filesystem::path& folder = own_.path();
};

/// A file of the data from elsewhere, or empty when this checkout has none.
std::string dataFile(const std::string& name);
std::string readText(const std::filesystem::path& path);

}  // namespace hairloom::test
