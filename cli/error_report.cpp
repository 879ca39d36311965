// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/error_report.h"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <system_error>

#ifndef _WIN32
#include <fcntl.h>
#include <unistd.h>
#endif

#include "core/base/utf8.h"

namespace hairloom::cli {
namespace {

using Json = nlohmann::ordered_json;

Json textOrNull(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Json placeOf(const Error& error) {
    if (const auto* line = std::get_if<Line>(&error.place)) return Json{{"line", line->number}};
    if (const auto* byte = std::get_if<Byte>(&error.place)) return Json{{"byte", byte->offset}};
    return nullptr;
}

}  // namespace

void printError(const Error& error, bool json) {
    // Not fmt::print(), which throws where the stream takes nothing.
    std::fputs(fmt::format("error: {}\n", cleanUtf8(error.message())).c_str(), stderr);
    if (json) printErrorObject(error);
}

void printErrorObject(const Error& error) {
    const Json object{{"error",
                       {{"file", textOrNull(error.file)},
                        {"place", placeOf(error)},
                        {"what", error.problem},
                        {"expected", textOrNull(error.expected)}}}};
    std::puts(object.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    std::fflush(stdout);
}

Status flushOutput() {
    errno = 0;
    std::cout.flush();
    const bool flushed = std::fflush(stdout) == 0;
    if (flushed && std::ferror(stdout) == 0 && std::cout.good()) return {};
    const int code = errno != 0 ? errno : EIO;
    return failIn("standard output", {}, "cannot be written: " + std::generic_category().message(code),
                  "expected space for the answer");
}

void keepStandardStreams() {
#ifndef _WIN32
    // Opened the wrong way round, so that what is printed fails and is noticed. The lowest number is given
    // first.
    for (int stream = 0; stream <= 2; ++stream) {
        if (fcntl(stream, F_GETFD) >= 0) continue;
        if (open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY) < 0) return;
    }
    // A reader that goes away is an error like a full disk, and temporary files are taken away.
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &ignore, nullptr);
#endif
}

}  // namespace hairloom::cli
