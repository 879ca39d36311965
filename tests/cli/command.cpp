// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/command.h"

#ifndef _WIN32
#include <sys/wait.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/source_dir.h"

namespace hairloom::test {

namespace fs = std::filesystem;

CommandLineTest::CommandLineTest() {
    // What a studio sets for all programs is not these tests' colours.
#ifdef _WIN32
    _putenv_s("OCIO", "");
#else
    unsetenv("OCIO");  // NOLINT(concurrency-mt-unsafe)
#endif
}

Outcome CommandLineTest::run(const std::string& arguments) const {
    const fs::path out = folder / "stdout.txt";
    const fs::path err = folder / "stderr.txt";
#ifdef _WIN32
    // cmd.exe takes away the outermost quotation marks, and knows no single ones.
    std::string words = arguments;
    std::ranges::replace(words, '\'', '"');
    const std::string command = "\"cd /d \"" + folder.string() + "\" && \"" HAIRLOOM_CLI "\" " + words +
                                " > \"" + out.string() + "\" 2> \"" + err.string() + "\"\"";
    const int exitCode = std::system(command.c_str());
#else
    const std::string command = "cd '" + folder.string() + "' && '" + HAIRLOOM_CLI + "' " + arguments +
                                " > '" + out.string() + "' 2> '" + err.string() + "'";
    const int status = std::system(command.c_str());
    const int exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
#endif
    Outcome outcome{exitCode, readText(out), readText(err)};
    fs::remove(out);
    fs::remove(err);
    return outcome;
}

nlohmann::json CommandLineTest::runJson(const std::string& arguments) const {
    const Outcome outcome = run(arguments + " --json");
    EXPECT_EQ(outcome.exitCode, 0) << arguments << "\n" << outcome.errors;
    if (outcome.exitCode != 0) return {};
    return outcome.json();
}

std::string bustFile() {
    return (sourceDir() / "samples/bust/bust.glb").string();
}

std::string dataFile(const std::string& name) {
    const fs::path path = outsideData() / name;
    return fs::exists(path) ? path.string() : std::string();
}

std::string readText(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace hairloom::test
