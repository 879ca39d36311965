// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/records.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hairloom::editing {

using Json = nlohmann::ordered_json;

Json runsOf(std::span<const std::uint32_t> ascending) {
    Json runs = Json::array();
    for (std::size_t i = 0; i < ascending.size();) {
        std::size_t end = i + 1;
        while (end < ascending.size() && ascending[end] == ascending[end - 1] + 1) ++end;
        runs.push_back(ascending[i]);
        runs.push_back(end - i);
        i = end;
    }
    return runs;
}

Indices readRuns(JsonReader& reader, std::string_view name) {
    constexpr double kLargest = 4294967295.0;
    const std::vector<double> runs = reader.numbers(name, 0, kLargest, kMaxNumbers);
    Indices numbers;
    std::uint64_t next = 0;
    for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
        const auto first = static_cast<std::uint64_t>(runs[i]);
        const auto count = static_cast<std::uint64_t>(runs[i + 1]);
        if (first < next || count > kMaxNumbers - numbers.size()) {
            reader.complain(name, fmt::format("does not ascend at value {}", i),
                            fmt::format("expected ascending runs of up to {} numbers", kMaxNumbers));
            return {};
        }
        for (std::uint64_t k = 0; k < count; ++k) numbers.push_back(static_cast<std::uint32_t>(first + k));
        next = first + count;
    }
    if (runs.size() % 2 != 0) reader.complain(name, "has an odd number of values", "first, count, …");
    return numbers;
}

std::string recordOf(std::string_view op, Json members) {
    Json record{{"op", op}};
    for (auto& [name, value] : members.items()) record[name] = std::move(value);
    return record.dump();
}

Status checkBelow(const Indices& indices, std::size_t count, std::string_view what) {
    if (indices.empty() || indices.back() < count) return {};
    return fail(fmt::format("{} {} does not exist", what, indices.back()),
                fmt::format("there are {}", count));
}

}  // namespace hairloom::editing
