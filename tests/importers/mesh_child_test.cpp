// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/child_process.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <cstring>

#include "tests/importers/mesh_files.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

Result<std::vector<std::byte>> shell(const std::string& script, const ChildLimits& limits = {}) {
    return runChild("the reader", "/bin/sh", {"-c", script}, limits);
}

std::string failure(const std::string& script, const ChildLimits& limits = {}) {
    const auto output = shell(script, limits);
    EXPECT_FALSE(output);
    return output ? std::string() : output.error().message();
}

TEST(ChildProcess, HandsBackWhatTheChildWrote) {
    const auto output = shell("printf abc; printf junk >&2; head -c 300000 /dev/zero");
    ASSERT_TRUE(output) << output.error().message();
    ASSERT_EQ(output->size(), 300'003u);
    EXPECT_EQ(std::memcmp(output->data(), "abc", 3), 0);
}

TEST(ChildProcess, ArgumentsAreNotInterpreted) {
    const auto output = runChild("the reader", "/bin/echo", {"-n", "a b; $(c) 'd'"}, {});
    ASSERT_TRUE(output);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(output->data()), output->size()), "a b; $(c) 'd'");
}

TEST(ChildProcess, CrashStatusAndAbsenceAreErrors) {
    EXPECT_THAT(failure("kill -SEGV $$"), HasSubstr("the reader crashed on this file (signal 11"));
    EXPECT_THAT(failure("printf half; exit 3"), HasSubstr("status 3"));
    const auto absent = runChild("the reader", "/nonexistent/program", {}, {});
    ASSERT_FALSE(absent);
    EXPECT_THAT(absent.error().message(), HasSubstr("cannot be started"));
}

TEST(ChildProcess, LimitsStopTheChild) {
    ChildLimits limits;
    limits.time = std::chrono::milliseconds(100);
    EXPECT_THAT(failure("sleep 60", limits), HasSubstr("did not finish within 0.1 s"));
    EXPECT_THAT(failure("exec >&-; sleep 60", limits), HasSubstr("did not finish"))
        << "output closed, still running";
    limits = {};
    limits.outputBytes = 1u << 20u;
    EXPECT_THAT(failure("cat /dev/zero", limits), HasSubstr("more than 1 MiB of data"));
    limits = {};
    limits.residentBytes = std::uint64_t{64} << 20u;
    EXPECT_THAT(failure("x=$(head -c 200000000 /dev/zero | tr '\\0' x); sleep 60", limits),
                HasSubstr("more than 64 MiB of memory"));
}

class MeshReader : public MeshFiles {
  protected:
    void TearDown() override {
        unsetenv("HAIRLOOM_MESH_READER");
        MeshFiles::TearDown();
    }
    /// The message for a sound file when the reader is this shell script.
    std::string withReader(const std::string& script) {
        const auto program = write("reader.sh", "#!/bin/sh\n" + script);
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        setenv("HAIRLOOM_MESH_READER", program.c_str(), 1);
        return refusal("a.stl",
                       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                       "endloop\nendfacet\nendsolid a\n");
    }
};

TEST_F(MeshReader, CrashAndNonsenseNameTheFile) {
    const std::string file = (folder / "a.stl").string();
    EXPECT_THAT(withReader("kill -ABRT $$\n"), testing::AllOf(HasSubstr(file), HasSubstr("signal 6")));
    EXPECT_THAT(withReader("echo nonsense\n"), testing::AllOf(HasSubstr(file), HasSubstr("makes no sense")));
    EXPECT_THAT(withReader("exit 0\n"), HasSubstr("makes no sense"));
}

}  // namespace
}  // namespace hairloom::test
