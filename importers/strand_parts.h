// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Parts that hair comes in (prims of USD, objects of Alembic, groups of OBJ and Unreal) and layers, both
// ways.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "importers/raw_strands.h"

namespace hairloom {

/// More parts than these are told by the parts above them.
inline constexpr std::size_t kMaxPartLayers = 256;

/// Strands that were appended since the last call belong to the part at `path` ("/groom/brows"), which is the
/// one of before where path and name are. `name` is what people call it, where the file says so.
void endPart(RawStrands& strands, const std::string& path, const std::string& name = {});

/// Parts become layers of the attribute "layer", of their own names, or of what tells their paths apart;
/// parts of one name are one layer. Where there is one part alone, groups become layers. Says how where parts
/// were too many. Readers call endPart() and nothing else: the import does this.
void layersFromParts(RawStrands& strands);

/// A name for each path, different for different paths and as short as that allows: its last part, or the
/// object above where each has one of its own ("/one/hair", "/two/hair": "one", "two"), or more of it.
std::vector<std::string> partNames(std::span<const std::string> paths);

/// Names of a file's own kind from names that people gave: what `isLegal` refuses becomes an underscore, and
/// names that became alike get a number behind. Stable: a name depends on those before it alone.
class NameGiver {
  public:
    using Legal = bool (*)(char c, bool isFirst);
    explicit NameGiver(Legal isLegal) : isLegal_(isLegal) {}

    std::string give(std::string_view name);
    /// From now on, no other gets it.
    void reserve(std::string_view name);

  private:
    Legal isLegal_;
    std::vector<std::string> taken_;  ///< ascending
};

/// Letters, digits and underscores, and no digit first: prims and properties of USD.
bool isLegalInUsd(char c, bool isFirst);
/// All but what separates objects and properties, and control characters: Alembic.
bool isLegalInAlembic(char c, bool isFirst);

}  // namespace hairloom
