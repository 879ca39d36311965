// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/takes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/output_file.h"
#include "core/base/utf8.h"
#include "core/documents/motions.h"
#include "core/groom/file/settings_json.h"
#include "core/simulation/frame_record.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 100;  ///< bytes, so that a temporary name beside it fits

/// A take that was cut off, by a name that none has; one without a whole block goes. One that cannot be read,
/// by this version or for now, stays for `clean`.
void recover(const LeftOver& leftOver, const fs::path& folder, std::vector<std::string>& recovered) {
    if (leftOver.whole || fs::path(leftOver.target).extension() != kTakeSuffix) return;
    const auto reader = TakeReader::open(leftOver.file);
    if (!reader) return;
    if (reader->info().frames == 0) return static_cast<void>(removeLeftOver(leftOver));
    const std::string stem = fs::path(leftOver.target).stem().string();
    std::string name = stem;
    std::error_code code;
    for (int i = 1; fs::exists(folder / (name + kTakeSuffix), code); ++i)
        name = i == 1 ? stem + " (recovered)" : fmt::format("{} (recovered {})", stem, i);
    fs::rename(leftOver.file, folder / (name + kTakeSuffix), code);
    if (!code) recovered.push_back(name);
}

/// con, nul, com1 …, whatever stands behind a dot.
bool isDeviceOfWindows(const std::string& name) {
    std::string base = name.substr(0, name.find('.'));
    std::ranges::transform(base, base.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const char* device : {"con", "prn", "aux", "nul"})
        if (base == device) return true;
    const bool isPort = base.size() == 4 && (base.starts_with("com") || base.starts_with("lpt"));
    return isPort && base[3] >= '1' && base[3] <= '9';
}

/// Notes as an object; empty where they are none.
nlohmann::json objectOf(const std::string& notes) {
    auto read = parseJson("notes", notes);
    return read && read->is_object() ? std::move(*read) : nlohmann::json::object();
}

}  // namespace

Result<TakeReader> openTakeFor(const fs::path& path, const Groom& groom) {
    auto reader = TakeReader::open(path);
    if (!reader) return reader;
    if (auto status = reader->use(groom); !status) return tl::unexpected(status.error());
    return reader;
}

fs::path takesFolder(const fs::path& project) {
    fs::path folder = project;
    return folder.replace_extension(".takes");
}

Result<fs::path> takePath(const fs::path& project, const std::string& name) {
    const auto wrong = [&](std::string what) {
        return fail(fmt::format("'{}' cannot name a take: {}", cleanUtf8(name), what),
                    "expected letters, digits, spaces, - and _, as in \"nod in wind\"");
    };
    if (name.empty()) return fail("a take needs a name", "expected letters, digits, spaces, - and _");
    if (name.size() > kLongestName) return wrong(fmt::format("it has more than {} bytes", kLongestName));
    if (cleanUtf8(name) != name) return wrong("it has control characters or bytes that are no UTF-8");
    if (const auto at = name.find_first_of("/\\:*?\"<>|"); at != std::string::npos)
        return wrong(fmt::format("it has '{}'", name[at]));
    if (name.front() == '.' || name.front() == '-' || name.front() == ' ' || name.back() == '.' ||
        name.back() == ' ')
        return wrong("it begins with a dot, a dash or a space, or ends with a dot or a space");
    if (isDeviceOfWindows(name)) return wrong("Windows keeps it for a device");
    return takesFolder(project) / fs::path(name + kTakeSuffix);
}

Takes findTakes(const fs::path& project) {
    Takes found;
    const fs::path folder = takesFolder(project);
    for (const LeftOver& leftOver : findLeftOvers(folder)) recover(leftOver, folder, found.recovered);
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const fs::path& file = entry->path();
        std::error_code ignored;
        if (file.extension() != kTakeSuffix || file.filename().string().starts_with('.') ||
            !entry->is_regular_file(ignored))
            continue;
        Take take{file.stem().string(), file, {}, {}};
        if (const auto reader = TakeReader::open(file)) {
            take.info = reader->info();
        } else {
            take.problem = reader.error().message();
            take.info.bytes = entry->file_size(ignored);
        }
        found.takes.push_back(std::move(take));
    }
    std::ranges::sort(found.takes, {}, &Take::name);
    return found;
}

Result<fs::path> existingTake(const fs::path& project, const std::string& name) {
    auto path = takePath(project, name);
    if (!path) return path;
    std::error_code code;
    if (fs::is_regular_file(*path, code)) return path;
    std::string names;
    for (const Take& take : findTakes(project).takes) {
        if (take.name == name) return path;  // recovered just now
        names += (names.empty() ? "" : ", ") + take.name;
    }
    return fail(fmt::format("there is no take '{}'", name),
                names.empty() ? "expected a take, and this project has none: takes --record makes one"
                              : "expected one of: " + names);
}

Status removeTake(const fs::path& project, const std::string& name) {
    const auto path = existingTake(project, name);
    if (!path) return tl::unexpected(path.error());
    std::error_code code;
    fs::remove(*path, code);
    if (code)
        return failIn(path->string(), {}, "cannot be removed: " + code.message(),
                      "expected a folder that can be written");
    fs::remove(takesFolder(project), code);  // where it is empty
    return {};
}

Status renameTake(const fs::path& project, const std::string& from, const std::string& to) {
    const auto source = existingTake(project, from);
    if (!source) return tl::unexpected(source.error());
    const auto target = takePath(project, to);
    if (!target) return tl::unexpected(target.error());
    std::error_code code;
    if (fs::exists(*target, code))
        return fail(fmt::format("there is a take '{}' already", to), "expected another name");
    fs::rename(*source, *target, code);
    if (code)
        return failIn(source->string(), {}, "cannot be renamed: " + code.message(),
                      "expected a folder that can be written");
    return {};
}

std::string takeNotes(const std::string& motion, const Groom& groom, const std::string& engine,
                      std::uint64_t preRoll) {
    const nlohmann::ordered_json notes{{"motion", motion},
                                       {"engine", engine},
                                       {"pre_roll", preRoll},
                                       {"settings", toJson(groom.simulation)}};
    return notes.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string motionOfNotes(const std::string& notes) {
    const auto read = objectOf(notes);
    const auto found = read.find("motion");
    return found != read.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string withLoop(const std::string& notes, const LoopNotes& loop) {
    nlohmann::ordered_json all = objectOf(notes);
    all["loop"] = {{"first", loop.first}, {"frames", loop.frames}, {"blend", loop.blend}};
    return all.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::optional<LoopNotes> loopOfNotes(const std::string& notes) {
    const auto read = objectOf(notes);
    const auto loop = read.find("loop");
    if (loop == read.end() || !loop->is_object()) return std::nullopt;
    const auto number = [&](const char* name) -> std::uint64_t {
        const auto found = loop->find(name);
        return found != loop->end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
    };
    return LoopNotes{number("first"), number("frames"), number("blend")};
}

std::optional<float> timeLineSeconds(const TakeInfo& info, std::uint64_t frame) {
    if (motionOfNotes(info.notes) != kTimeLineMotion) return std::nullopt;
    const auto loop = loopOfNotes(info.notes);
    return static_cast<float>((loop ? loop->first : 0) + frame + 1) / info.framesPerSecond;
}

std::uint64_t frameAtTimeLine(const TakeInfo& info, float seconds) {
    const double number =
        std::round(static_cast<double>(seconds) * static_cast<double>(info.framesPerSecond)) - 1;
    const auto frame = static_cast<std::uint64_t>(std::max(number, 0.0));
    const auto loop = loopOfNotes(info.notes);
    if (!loop || info.frames == 0) return frame;
    return (frame + info.frames - loop->first % info.frames) % info.frames;
}

Result<TakeDifference> compareTakes(const fs::path& a, const fs::path& b, const Groom& groom,
                                    const std::function<void(std::uint64_t)>& progress) {
    auto first = openTakeFor(a, groom);
    if (!first) return tl::unexpected(first.error());
    auto second = openTakeFor(b, groom);
    if (!second) return tl::unexpected(second.error());
    const float rate = first->info().framesPerSecond, other = second->info().framesPerSecond;
    if (rate != other)
        return failIn(b.string(), {}, fmt::format("has {:g} frames a second", other),
                      fmt::format("{} has {:g}", a.string(), rate));
    const std::uint64_t count = std::min(first->info().frames, second->info().frames);
    if (count == 0 || groom.pointCount() == 0)
        return fail("the takes have no frame in common", "expected takes of a frame or more");
    TakeDifference difference;
    double sum = 0;
    for (std::uint64_t number = 0; number < count; ++number) {
        const auto one = first->frame(number);
        if (!one) return tl::unexpected(one.error());
        const auto two = second->frame(number);
        if (!two) return tl::unexpected(two.error());
        double squares = 0, largest = 0;
        for (std::size_t p = 0; p < one->positions_ws.size(); ++p) {
            const double squared = (one->positions_ws[p] - two->positions_ws[p]).cast<double>().squaredNorm();
            squares += squared;
            largest = std::max(largest, squared);
        }
        sum += squares;
        const auto points = static_cast<double>(one->positions_ws.size());
        difference.frames.push_back({number, 1e3 * std::sqrt(squares / points), 1e3 * std::sqrt(largest)});
        if (difference.frames.back().largestMm > difference.largestMm) {
            difference.largestMm = difference.frames.back().largestMm;
            difference.worstFrame = number;
        }
        progress(number + 1);
    }
    difference.rmsMm =
        1e3 * std::sqrt(sum / (static_cast<double>(groom.pointCount()) * static_cast<double>(count)));
    return difference;
}

}  // namespace hairloom
