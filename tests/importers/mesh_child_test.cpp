// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/child_process.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <cstring>

#include "tests/importers/mesh_files.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

#ifdef _WIN32
constexpr const char* kCrash = "crashed on this file (exception 0xc0000005";
#else
constexpr const char* kCrash = "crashed on this file (signal 11";
#endif

/// child_program.cpp says how the child can behave.
Result<std::vector<std::byte>> runProgram(const std::vector<std::string>& words,
                                          const ChildLimits& limits = {}) {
    return runChild("the reader", HAIRLOOM_TEST_CHILD_PROGRAM, words, limits);
}

std::string failure(const std::string& how, const ChildLimits& limits = {}) {
    const auto output = runProgram({how}, limits);
    EXPECT_FALSE(output);
    return output ? std::string() : output.error().message();
}

TEST(ChildProcess, ReturnsOutputOfTheChild) {
    const auto output = runProgram({"output"});
    ASSERT_TRUE(output) << output.error().message();
    ASSERT_EQ(output->size(), 300'003u);
    EXPECT_EQ(std::memcmp(output->data(), "abc", 3), 0);
}

TEST(ChildProcess, ArgumentsAreNotInterpreted) {
    const std::vector<std::string> words = {"words", "a b; $(c) 'd'", "", "\"e\\\" f\\", "%g% ^&|"};
    const auto output = runProgram(words);
    ASSERT_TRUE(output) << output.error().message();
    std::string expected;
    for (std::size_t i = 1; i < words.size(); ++i) expected += words[i] + "\n";
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(output->data()), output->size()), expected);
}

TEST(ChildProcess, CrashStatusAndAbsenceAreErrors) {
    EXPECT_THAT(failure("crash"), HasSubstr(std::string("the reader ").append(kCrash)));
    EXPECT_THAT(failure("half"), HasSubstr("status 3"));
    const auto absent = runChild("the reader", "/nonexistent/program", {}, {});
    ASSERT_FALSE(absent);
    EXPECT_THAT(absent.error().message(), HasSubstr("cannot be started"));
}

TEST(ChildProcess, LimitsStopTheChild) {
    ChildLimits limits;
    limits.time = std::chrono::milliseconds(100);
    EXPECT_THAT(failure("hang", limits), HasSubstr("did not finish within 0.1 s"));
    EXPECT_THAT(failure("close and hang", limits), HasSubstr("did not finish"))
        << "output closed, still running";
    limits = {};
    limits.outputBytes = 1u << 20u;
    EXPECT_THAT(failure("flood", limits), HasSubstr("more than 1 MiB of data"));
    limits = {};
    limits.residentBytes = std::uint64_t{64} << 20u;
#ifdef _WIN32
    // The job may deny the memory before the watch sees it.
    EXPECT_THAT(failure("memory", limits), testing::AnyOf(HasSubstr("more than 64 MiB of memory"),
                                                          HasSubstr("status"), HasSubstr("crashed")));
#else
    EXPECT_THAT(failure("memory", limits), HasSubstr("more than 64 MiB of memory"));
#endif
}

void setVariable(const char* name, const char* value) {
#ifdef _WIN32
    _putenv_s(name, value);  // empty: removes it
#else
    setenv(name, value, 1);
#endif
}

class MeshReader : public MeshFiles {
  protected:
    void TearDown() override {
        setVariable("HAIRLOOM_MESH_READER", "");
        setVariable("HAIRLOOM_TEST_CHILD", "");
        MeshFiles::TearDown();
    }
    /// The message for a sound file when the reader behaves like this.
    std::string withReader(const char* how) {
        setVariable("HAIRLOOM_MESH_READER", HAIRLOOM_TEST_CHILD_PROGRAM);
        setVariable("HAIRLOOM_TEST_CHILD", how);
        return refusal("a.stl",
                       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                       "endloop\nendfacet\nendsolid a\n");
    }
};

TEST_F(MeshReader, CrashAndNonsenseNameTheFile) {
    const std::string file = (folder / "a.stl").string();
    EXPECT_THAT(withReader("crash"), testing::AllOf(HasSubstr(file), HasSubstr(kCrash)));
    EXPECT_THAT(withReader("nonsense"), testing::AllOf(HasSubstr(file), HasSubstr("is invalid")));
    EXPECT_THAT(withReader("nothing"), HasSubstr("is invalid"));
}

}  // namespace
}  // namespace hairloom::test
