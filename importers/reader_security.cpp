// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/reader_security.h"

#include <atomic>
#include <filesystem>
#include <sstream>

#ifdef _WIN32
#include <process.h>
#else
#include <unistd.h>
#endif

#include "importers/child_process.h"
#include "importers/mesh_reader_program.h"

namespace hairloom {
namespace {

std::atomic<bool>& allowed() {
    static std::atomic<bool> instance{false};
    return instance;
}

std::string ownProcess() {
#ifdef _WIN32
    return std::to_string(_getpid());
#else
    return std::to_string(getpid());
#endif
}

}  // namespace

void allowUnconfinedReaders(bool isAllowed) {
    allowed() = isAllowed;
}

bool areUnconfinedReadersAllowed() {
    return allowed();
}

Result<std::vector<std::pair<std::string, std::string>>> readerSecurity() {
    const std::filesystem::path reader = meshReaderProgram();
    const auto output = runChild("the mesh reader", reader,
                                 {"--security", std::filesystem::temp_directory_path().string(),
                                  std::filesystem::absolute(reader).string(), ownProcess()},
                                 {});
    if (!output) return tl::unexpected(output.error());
    std::istringstream lines(std::string(reinterpret_cast<const char*>(output->data()), output->size()));
    std::vector<std::pair<std::string, std::string>> found;
    for (std::string name, value; lines >> name >> value;) found.emplace_back(name, value);
    return found;
}

}  // namespace hairloom
