// SPDX-License-Identifier: GPL-3.0-or-later
// Lists in binary USD, and edits of lists: references, payloads, paths, layers, chosen variants.

#include <fmt/format.h>

#include <algorithm>

#include "importers/usdc_types.h"
#include "importers/usdc_values.h"

namespace hairloom {

using namespace usdc;

Status UsdcValues::readOffset(UsdTimeOffset& time) {
    const auto numbers = in_.readArray<double>(2, "an offset in time");
    if (!numbers) return tl::unexpected(numbers.error());
    time = {(*numbers)[0], (*numbers)[1]};
    return {};
}

/// An entry is a name, a jump over what the value needs, and the value.
Status UsdcValues::readDictionary(const std::string& key, const KeepValue& keep, std::uint32_t depth) {
    constexpr std::uint64_t kEntry = sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
    constexpr std::uint32_t kMaxDepth = 32;
    constexpr std::uint64_t kMaxTexts = 1 << 16u;
    if (depth > kMaxDepth)
        return error("dictionaries are nested too deep", fmt::format("expected {}", kMaxDepth));
    const auto count = in_.read<std::uint64_t>("the size of a dictionary");
    if (!count) return tl::unexpected(count.error());
    if (*count > in_.remaining() / kEntry)
        return error(fmt::format("a dictionary of {} entries goes beyond the end of the file", *count));
    // Dictionaries may name the same bytes again and again.
    dictionaryEntries_ += *count;
    if (dictionaryEntries_ > kMaxTexts)
        return error("its dictionaries have more entries than are kept",
                     fmt::format("expected {}", kMaxTexts));
    for (std::uint64_t i = 0; i < *count; ++i) {
        const auto name = in_.read<std::uint32_t>("a name in a dictionary");
        if (!name) return tl::unexpected(name.error());
        if (auto status = jump(); !status) return status;
        const auto bits = in_.read<std::uint64_t>("a value in a dictionary");
        if (!bits) return tl::unexpected(bits.error());
        const UsdcValue value{*bits};
        const std::string own = key.empty() ? file_.string(*name) : key + ':' + file_.string(*name);
        const std::uint64_t behind = in_.position();
        if (value.type() == Dictionary && !value.isInlined()) {
            if (auto status = in_.seek(value.payload(), "a dictionary"); !status) return status;
            if (auto status = readDictionary(own, keep, depth + 1); !status) return status;
        } else if (auto status = keep(own, value); !status) {
            return status;
        }
        if (auto status = in_.seek(behind, "a dictionary"); !status) return status;
    }
    return {};
}

Status UsdcValues::readDictionaryOf(const UsdcValue& value, const KeepValue& keep) {
    if (value.type() != Dictionary || value.isInlined()) return {};
    if (auto status = in_.seek(value.payload(), "a dictionary"); !status) return status;
    return readDictionary({}, keep, 0);
}

Result<std::map<std::string, std::string, std::less<>>> UsdcValues::textsIn(const UsdcValue& value) {
    std::map<std::string, std::string, std::less<>> texts;
    const auto keep = [&](const std::string& key, const UsdcValue& one) -> Status {
        if (one.type() == String && one.isInlined() && !one.isArray())
            texts[key] = file_.string(one.payload());
        return {};
    };
    if (auto status = readDictionaryOf(value, keep); !status) return tl::unexpected(status.error());
    return texts;
}

Result<UsdDictionary> UsdcValues::valuesIn(const UsdcValue& value) {
    UsdDictionary values;
    const auto keep = [&](const std::string& key, const UsdcValue& one) -> Status {
        auto read = valueOf(one);
        if (!read) return tl::unexpected(read.error());
        values[key] = std::move(*read);
        return {};
    };
    if (auto status = readDictionaryOf(value, keep); !status) return tl::unexpected(status.error());
    return values;
}

Result<UsdArc> UsdcValues::item(std::uint8_t kind) {
    UsdArc arc;
    if (kind != PathListOp) {
        const auto asset = in_.read<std::uint32_t>("the name of a file");
        if (!asset) return tl::unexpected(asset.error());
        arc.asset = file_.string(*asset);
    }
    const auto path = in_.read<std::uint32_t>("a path");
    if (!path) return tl::unexpected(path.error());
    arc.path = file_.pathText(*path);
    // Of the root or of none: the default prim.
    if (arc.path == "/") arc.path.clear();
    if (kind == ReferenceListOp || ((kind == PayloadListOp || kind == Payload) && file_.isSince(8))) {
        if (auto status = readOffset(arc.time); !status) return tl::unexpected(status.error());
    }
    if (kind == ReferenceListOp) {
        const auto ignore = [](const std::string&, const UsdcValue&) { return Status(); };
        if (auto status = readDictionary({}, ignore, 0); !status) return tl::unexpected(status.error());
    }
    return arc;
}

Result<std::vector<UsdArc>> UsdcValues::items(std::uint8_t kind) {
    const auto count = in_.read<std::uint64_t>("the length of a list");
    if (!count) return tl::unexpected(count.error());
    if (*count > in_.remaining() / sizeof(std::uint32_t))
        return error(fmt::format("a list of {} goes beyond the end of the file", *count));
    std::vector<UsdArc> arcs;
    for (std::uint64_t i = 0; i < *count; ++i) {
        auto arc = item(kind);
        if (!arc) return tl::unexpected(arc.error());
        if (!arc->asset.empty() || !arc->path.empty()) arcs.push_back(std::move(*arc));
    }
    return arcs;
}

template <class T, class Read>
Result<UsdListEdits<T>> UsdcValues::editsBy(Read read) {
    const auto bits = in_.read<std::uint8_t>("an edit of a list");
    if (!bits) return tl::unexpected(bits.error());
    enum : std::uint8_t {
        IsExplicit = 1,
        Items = 2,
        Added = 4,
        Deleted = 8,
        Ordered = 16,
        Front = 32,
        Back = 64
    };
    UsdListEdits<T> edits;
    edits.isExplicit = (*bits & IsExplicit) != 0;
    // In the order in which they stand.
    std::vector<T> ordered;
    for (const auto& [bit, list] : {std::pair(Items, &edits.items), std::pair(Added, &edits.appended),
                                    std::pair(Front, &edits.items), std::pair(Back, &edits.appended),
                                    std::pair(Deleted, &edits.deleted), std::pair(Ordered, &ordered)}) {
        if ((*bits & bit) == 0) continue;
        auto found = read();
        if (!found) return tl::unexpected(found.error());
        list->insert(list->end(), found->begin(), found->end());
    }
    return edits;
}

Result<UsdArcs> UsdcValues::arcsOf(const UsdcValue& value) {
    UsdArcs arcs;
    const std::uint8_t kind = value.type();
    if (value.isInlined() ||
        (kind != PathListOp && kind != ReferenceListOp && kind != PayloadListOp && kind != Payload))
        return arcs;
    if (auto status = in_.seek(value.payload(), "references"); !status) return tl::unexpected(status.error());
    if (kind == Payload) {
        auto arc = item(kind);
        if (!arc) return tl::unexpected(arc.error());
        arcs.isExplicit = true;
        if (!arc->asset.empty() || !arc->path.empty()) arcs.items.push_back(std::move(*arc));
        return arcs;
    }
    return editsBy<UsdArc>([&] { return items(kind); });
}

Result<UsdListEdits<std::int64_t>> UsdcValues::wholesOf(const UsdcValue& value) {
    if (value.isInlined() || value.type() != Int64ListOp) return UsdListEdits<std::int64_t>();
    if (auto status = in_.seek(value.payload(), "a list of numbers"); !status)
        return tl::unexpected(status.error());
    return editsBy<std::int64_t>([&]() -> Result<std::vector<std::int64_t>> {
        const auto count = in_.read<std::uint64_t>("the length of a list");
        if (!count) return tl::unexpected(count.error());
        if (auto status = keep(*count); !status) return tl::unexpected(status.error());
        return in_.readArray<std::int64_t>(*count, "a list of numbers");
    });
}

Result<UsdListEdits<std::string>> UsdcValues::textEditsOf(const UsdcValue& value) {
    if (value.isInlined() || value.type() != StringListOp) return UsdListEdits<std::string>();
    if (auto status = in_.seek(value.payload(), "a list of texts"); !status)
        return tl::unexpected(status.error());
    return editsBy<std::string>([&]() -> Result<std::vector<std::string>> {
        const auto count = in_.read<std::uint64_t>("the length of a list");
        if (!count) return tl::unexpected(count.error());
        if (auto status = keep(*count); !status) return tl::unexpected(status.error());
        const auto indices = in_.readArray<std::uint32_t>(*count, "a list of texts");
        if (!indices) return tl::unexpected(indices.error());
        std::vector<std::string> texts;
        for (const std::uint32_t index : *indices) texts.push_back(file_.string(index));
        return texts;
    });
}

Result<std::vector<std::string>> UsdcValues::pathsOf(const UsdcValue& value) {
    const auto arcs = arcsOf(value);
    if (!arcs) return tl::unexpected(arcs.error());
    std::vector<std::string> paths;
    for (const UsdArc& arc : arcs->all()) paths.push_back(arc.path);
    return paths;
}

Result<std::map<std::string, std::string>> UsdcValues::selectionsOf(const UsdcValue& value) {
    std::map<std::string, std::string> selections;
    if (value.isInlined() || value.type() != VariantSelectionMap) return selections;
    if (auto status = in_.seek(value.payload(), "chosen variants"); !status)
        return tl::unexpected(status.error());
    const auto count = in_.read<std::uint64_t>("the number of chosen variants");
    if (!count) return tl::unexpected(count.error());
    if (*count > in_.remaining() / (2 * sizeof(std::uint32_t)))
        return error(fmt::format("{} chosen variants go beyond the end of the file", *count));
    const auto names = in_.readArray<std::uint32_t>(2 * *count, "chosen variants");
    if (!names) return tl::unexpected(names.error());
    for (std::size_t i = 0; i + 1 < names->size(); i += 2)
        selections.emplace(file_.string((*names)[i]), file_.string((*names)[i + 1]));
    return selections;
}

Result<std::vector<UsdArc>> UsdcValues::subLayersOf(const UsdcValue& names, const UsdcValue& times) {
    std::vector<UsdArc> layers;
    if (names.isInlined() || names.type() != StringVector) return layers;
    if (auto status = in_.seek(names.payload(), "layers"); !status) return tl::unexpected(status.error());
    const auto count = in_.read<std::uint64_t>("the number of layers");
    if (!count) return tl::unexpected(count.error());
    const auto indices = in_.readArray<std::uint32_t>(*count, "layers");
    if (!indices) return tl::unexpected(indices.error());
    for (const std::uint32_t index : *indices) layers.emplace_back().asset = file_.string(index);
    if (times.isInlined() || times.type() != LayerOffsetVector) return layers;
    if (auto status = in_.seek(times.payload(), "times of layers"); !status)
        return tl::unexpected(status.error());
    const auto offsets = in_.read<std::uint64_t>("the number of times of layers");
    if (!offsets) return tl::unexpected(offsets.error());
    for (std::size_t i = 0; i < std::min<std::uint64_t>(*offsets, layers.size()); ++i) {
        if (auto status = readOffset(layers[i].time); !status) return tl::unexpected(status.error());
    }
    return layers;
}

std::vector<std::string> UsdcValues::tokensOf(const UsdcValue& value) {
    std::vector<std::string> texts;
    if (value.isInlined() || !in_.seek(value.payload(), "a list of names")) return texts;
    const auto count = in_.read<std::uint64_t>("its length");
    const auto indices =
        count ? in_.readArray<std::uint32_t>(*count, "names") : Result<std::vector<std::uint32_t>>();
    if (!count || !indices) return texts;
    for (const std::uint32_t index : *indices) texts.push_back(file_.token(index));
    return texts;
}

}  // namespace hairloom
