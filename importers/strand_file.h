// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One file of strands by the reader of its format, and what the program that does it is told.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "importers/raw_strands.h"

namespace hairloom {

/// What lies beside a file of strands under its name, by suffix.
struct Companion {
    std::string name;  ///< as errors call it
    Result<std::vector<std::byte>> bytes;
};
using Companions = std::map<std::string, Companion, std::less<>>;

/// Paths of companions, by suffix.
using CompanionPaths = std::map<std::string, std::filesystem::path, std::less<>>;

/// Of every format that may have one. `path` is where the file is, `named` what errors call it; those in
/// `elsewhere` do not lie beside it.
Companions readCompanions(const std::filesystem::path& path, const std::filesystem::path& named,
                          const CompanionPaths& elsewhere = {});

/// The file's own numbers, by the first reader that knows the content. Errors: as importStrands().
Result<RawStrands> readStrandFile(const std::string& file, std::vector<std::byte> bytes,
                                  const StrandImportOptions& options, const Companions& companions);

/// What readers look at of the options, as words of a command line, and back; false for a word that is none
/// of them.
std::vector<std::string> wordsOf(const StrandImportOptions& options);
bool takeWord(std::string_view word, StrandImportOptions& options);

}  // namespace hairloom
