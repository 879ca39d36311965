// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Value clips of USD: values of a prim and of what lies below it that are in other files, which follow one
// another in time.

#include <functional>
#include <map>
#include <string>

#include "importers/usd_files.h"

namespace hairloom {

/// What stronger layers of a stack say of clips, by the paths of prims.
using UsdStrongerClips = std::map<std::string, UsdDictionary>;

/// Puts values of clips where attributes have samples. They are weaker than what the layer that names the
/// clips says, and stronger than all below it (OpenUSD, "Sequencable, Re-timeable Animated Value Clips").
class UsdValueClips {
  public:
    /// `note` is told what is left out, and why. Both must outlive it.
    UsdValueClips(UsdFiles& files, std::function<void(std::string)> note)
        : files_(files), note_(std::move(note)) {}

    /// Into the prims of a layer, whose samples are in the times of its stack; `time` is that of the layer
    /// in these. What the layer says of clips joins `stronger`.
    void addTo(UsdPrim& root, const std::string& key, const UsdTimeOffset& time, UsdStrongerClips& stronger);
    /// More numbers were asked for than are kept; the rest is missing.
    bool isFull() const;

  private:
    struct Set;
    struct Clips;
    void visit(UsdPrim& prim, const std::string& path, const std::string& key, const UsdTimeOffset& time,
               UsdStrongerClips& stronger);
    /// Of the dictionary; false, with a word, where it is no set.
    bool readSet(const UsdDictionary& all, const std::string& name, Set& set);
    bool expandTemplate(const UsdDictionary& all, const std::string& name, Set& set);
    void addSet(UsdPrim& prim, const Set& set);
    UsdLayer* open(const Set& set, const std::string& asset, const char* what, Clips& clips);
    UsdValue timed(const UsdAttribute& attribute, double time);
    std::map<double, UsdValue> samplesOf(const Set& set,
                                         const std::map<std::size_t, const UsdAttribute*>& ofClips,
                                         const UsdValue& otherwise);

    UsdFiles& files_;
    std::function<void(std::string)> note_;
    std::uint64_t numbers_ = 0;
};

/// Values of clips declare no attribute: takes away those that nothing else has, unless their prim's schema
/// does.
void eraseUndeclared(UsdPrim& root);

}  // namespace hairloom
