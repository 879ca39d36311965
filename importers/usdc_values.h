// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The values of a binary USD file, from what its fields say of them.

#include <functional>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "importers/usd_stage.h"
#include "importers/usdc_file.h"

namespace hairloom {

class UsdcValues {
  public:
    /// `file` must outlive it.
    explicit UsdcValues(const UsdcFile& file) : file_(file), in_(file.name(), file.bytes()) {}

    /// Numbers and texts; nothing of other types.
    Result<UsdValue> valueOf(const UsdcValue& value);
    /// Samples in time, into the attribute.
    Status readSamples(const UsdcValue& value, UsdAttribute& attribute);
    /// References, payloads, or paths of prims that are inherited; nothing of other types.
    Result<UsdArcs> arcsOf(const UsdcValue& value);
    /// A list of whole numbers; nothing of other types.
    Result<UsdListEdits<std::int64_t>> wholesOf(const UsdcValue& value);
    /// Of paths that a relationship has.
    Result<std::vector<std::string>> pathsOf(const UsdcValue& value);
    Result<std::map<std::string, std::string>> selectionsOf(const UsdcValue& value);
    /// Texts of a dictionary and of those in it, by their keys: "hairloom:settings".
    Result<std::map<std::string, std::string, std::less<>>> textsIn(const UsdcValue& value);
    /// All of a dictionary and of those in it, by their keys.
    Result<UsdDictionary> valuesIn(const UsdcValue& value);
    /// A list of texts; nothing of other types.
    Result<UsdListEdits<std::string>> textEditsOf(const UsdcValue& value);
    /// Files below a layer, with what its field of their times says.
    Result<std::vector<UsdArc>> subLayersOf(const UsdcValue& names, const UsdcValue& times);
    /// A list of names; empty where it is damaged, since their order alone is at stake.
    std::vector<std::string> tokensOf(const UsdcValue& value);

  private:
    tl::unexpected<Error> error(std::string problem, std::string expected = {}) const {
        return tl::unexpected(in_.error(std::move(problem), std::move(expected)));
    }
    struct Layout;
    static Layout layoutOf(std::uint8_t type);
    static void inlined(const UsdcValue& value, const Layout& layout, UsdNumbers& numbers);
    Result<UsdValue> textsOf(const UsdcValue& value);
    Result<std::uint64_t> arraySize(const UsdcValue& value);
    Status readArray(const UsdcValue& value, const Layout& layout, UsdNumbers& numbers);
    Status readPlain(const Layout& layout, std::uint64_t count, UsdNumbers& numbers);
    Status readPacked(std::uint8_t component, std::uint64_t count, UsdNumbers& numbers);
    /// So many numbers of all values together: fields may name the same bytes again and again.
    Status keep(std::uint64_t numbers);
    /// Goes where a number of bytes says that what follows stands.
    Status jump();
    Result<std::vector<double>> timesOf(const UsdcValue& value);

    /// The items of one list of an edit, `kind` of them.
    Result<std::vector<UsdArc>> items(std::uint8_t kind);
    Result<UsdArc> item(std::uint8_t kind);
    /// The lists that an edit has, each by `read`.
    template <class T, class Read>
    Result<UsdListEdits<T>> editsBy(Read read);
    Status readOffset(UsdTimeOffset& time);
    /// Gives its values and those of dictionaries in it to `keep`, by keys that begin with `key`.
    using KeepValue = std::function<Status(const std::string& key, const UsdcValue& value)>;
    Status readDictionary(const std::string& key, const KeepValue& keep, std::uint32_t depth);
    Status readDictionaryOf(const UsdcValue& value, const KeepValue& keep);

    const UsdcFile& file_;
    ByteReader in_;
    std::uint64_t kept_ = 0, dictionaryEntries_ = 0;
};

}  // namespace hairloom
