// SPDX-License-Identifier: GPL-3.0-or-later
// Binary USD as a stage: the values of prims and attributes that hair needs.

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "core/base/file.h"
#include "importers/usd_stage.h"
#include "importers/usdc_file.h"
#include "importers/usdc_packing.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kMaxDepth = 128;  ///< of prims in each other

/// Types of values by their numbers in the file.
enum Type : std::uint8_t {
    Bool = 1,
    UChar,
    Int,
    UInt,
    Int64,
    UInt64,
    Half,
    Float,
    Double,
    String,
    Token,
    AssetPath,
    Matrix2d,
    Matrix3d,
    Matrix4d,
    Quatd,
    Quatf,
    Quath,
    Vec2d,
    Vec2f,
    Vec2h,
    Vec2i,
    Vec3d,
    Vec3f,
    Vec3h,
    Vec3i,
    Vec4d,
    Vec4f,
    Vec4h,
    Vec4i,
    TokenVector = 41,
    Specifier = 42,
    TimeSamples = 46,
    DoubleVector = 48
};

/// What the numbers of a type are, and how many of them an element has; 0 of what has none.
struct Layout {
    Type component = Float;
    std::uint32_t count = 0;
};
Layout layoutOf(std::uint8_t type) {
    switch (type) {
        case Bool:
        case UChar:
            return {UChar, 1};
        case Int:
        case UInt:
        case Int64:
        case UInt64:
        case Half:
        case Float:
        case Double:
            return {static_cast<Type>(type), 1};
        case Matrix2d:
            return {Double, 4};
        case Matrix3d:
            return {Double, 9};
        case Matrix4d:
            return {Double, 16};
        default:
            break;
    }
    constexpr std::array kQuats{Double, Float, Half};
    if (type >= Quatd && type <= Quath) return {kQuats[type - Quatd], 4};
    if (type < Vec2d || type > Vec4i) return {};
    constexpr std::array kVectors{Double, Float, Half, Int};
    return {kVectors[(type - Vec2d) % 4u], 2 + (type - Vec2d) / 4u};
}

std::size_t sizeOf(Type component) {
    switch (component) {
        case UChar:
            return 1;
        case Half:
            return 2;
        case Int64:
        case UInt64:
        case Double:
            return 8;
        default:
            return 4;
    }
}

template <class T>
T as(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

double numberAt(const std::byte* at, Type component) {
    switch (component) {
        case UChar:
            return std::to_integer<std::uint8_t>(*at);
        case Int:
            return as<std::int32_t>(at);
        case UInt:
            return as<std::uint32_t>(at);
        case Int64:
            return static_cast<double>(as<std::int64_t>(at));
        case UInt64:
            return static_cast<double>(as<std::uint64_t>(at));
        case Half:
            return static_cast<double>(
                static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(as<std::uint16_t>(at))));
        case Double:
            return as<double>(at);
        default:
            return double{as<float>(at)};
    }
}

class Reader {
  public:
    explicit Reader(const UsdcFile& file) : file_(file), in_(file.name(), file.bytes()) {}

    Result<UsdStage> run() {
        const auto& paths = file_.paths();
        std::vector<const UsdcSpec*> specOfPath(paths.size(), nullptr);
        for (const UsdcSpec& spec : file_.specs()) specOfPath[spec.path] = &spec;
        children_.resize(paths.size());
        for (std::uint32_t path = 0; path < paths.size(); ++path) {
            const bool isKnown = specOfPath[path] != nullptr && paths[path].parent < paths.size();
            if (isKnown) children_[paths[path].parent].push_back(path);
        }
        const auto root = std::ranges::find(file_.specs(), kUsdcRoot, &UsdcSpec::type);
        if (root == file_.specs().end()) return failIn(file_.name(), {}, "has no root", "expected a stage");
        std::vector<std::string> childNames;
        for (const UsdcField& field : file_.fieldsOf(*root)) {
            const std::string& name = file_.token(field.token);
            if (name == "primChildren") childNames = tokensOf(field.value);
            if (layoutOf(field.value.type()).count == 0 && field.value.type() != Token) {
                if (name == "subLayers") stage_.notFollowed.push_back("its layers");
                continue;
            }
            auto value = valueOf(field.value);
            if (!value) return tl::unexpected(value.error());
            stage_.metadata[name] = std::move(*value);
        }
        specs_ = std::move(specOfPath);
        if (auto status = addChildren(root->path, stage_.root, 0, childNames); !status)
            return tl::unexpected(status.error());
        return std::move(stage_);
    }

  private:
    tl::unexpected<Error> error(std::string problem, std::string expected = {}) const {
        return tl::unexpected(in_.error(std::move(problem), std::move(expected)));
    }

    /// `names` are the stage's order of prims; the file lists them in any.
    Status addChildren(std::uint32_t path, UsdPrim& prim, std::uint32_t depth,
                       const std::vector<std::string>& names) {
        if (depth > kMaxDepth)
            return error("prims are nested too deep", fmt::format("expected {}", kMaxDepth));
        std::unordered_map<std::string_view, std::size_t> rank;
        for (const std::string& name : names) rank.emplace(name, rank.size());
        std::vector<std::uint32_t> order = children_[path];
        std::ranges::stable_sort(order, {}, [&](std::uint32_t child) {
            const auto found = rank.find(file_.token(file_.paths()[child].token));
            return found == rank.end() ? rank.size() : found->second;
        });
        for (const std::uint32_t child : order) {
            const UsdcSpec& spec = *specs_[child];
            if (spec.type == kUsdcPrim && !file_.paths()[child].isProperty) {
                if (auto status = addPrim(child, prim, depth); !status) return status;
            } else if (spec.type == kUsdcAttribute) {
                if (auto status = addAttribute(child, prim); !status) return status;
            }
        }
        return {};
    }

    Status addPrim(std::uint32_t path, UsdPrim& parent, std::uint32_t depth) {
        UsdPrim prim;
        prim.name = file_.token(file_.paths()[path].token);
        std::vector<std::string> childNames;
        for (const UsdcField& field : file_.fieldsOf(*specs_[path])) {
            const std::string& name = file_.token(field.token);
            if (name == "typeName") prim.type = file_.token(field.value.payload());
            if (name == "specifier") prim.isOver = field.value.payload() != 0;
            if (name == "primChildren") childNames = tokensOf(field.value);
            if (name == "references" || name == "payload" || name == "inheritPaths")
                stage_.notFollowed.push_back(fmt::format("{} of {}", name, prim.name));
            if (name == "variantSetNames") stage_.notFollowed.push_back("the variants of " + prim.name);
        }
        if (auto status = addChildren(path, prim, depth + 1, childNames); !status) return status;
        parent.children.push_back(std::move(prim));
        return {};
    }

    Status addAttribute(std::uint32_t path, UsdPrim& prim) {
        UsdAttribute attribute;
        attribute.name = file_.token(file_.paths()[path].token);
        for (const UsdcField& field : file_.fieldsOf(*specs_[path])) {
            const std::string& name = file_.token(field.token);
            if (name == "typeName") attribute.type = file_.token(field.value.payload());
            if (name == "interpolation") attribute.interpolation = file_.token(field.value.payload());
            if (name != "default" && name != "elementSize" && name != "timeSamples") continue;
            if (name == "timeSamples") {
                if (auto status = readSamples(field.value, attribute); !status) return status;
                continue;
            }
            auto value = valueOf(field.value);
            if (!value) return tl::unexpected(value.error());
            if (name == "default") attribute.value = std::move(*value);
            if (name == "elementSize" && !value->numbers.empty())
                attribute.elementSize = value->numbers.front();
        }
        prim.attributes.push_back(std::move(attribute));
        return {};
    }

    /// Of a list of tokens; empty where it is damaged, since the order alone is at stake.
    std::vector<std::string> tokensOf(const UsdcValue& value) {
        std::vector<std::string> texts;
        if (value.isInlined() || !in_.seek(value.payload(), "a list of names")) return texts;
        const auto count = in_.read<std::uint64_t>("its length");
        const auto indices =
            count ? in_.readArray<std::uint32_t>(*count, "names") : Result<std::vector<std::uint32_t>>();
        if (!count || !indices) return texts;
        for (const std::uint32_t index : *indices) texts.push_back(file_.token(index));
        return texts;
    }

    /// Numbers and tokens; nothing of other types.
    Result<UsdValue> valueOf(const UsdcValue& value) {
        UsdValue result;
        if (value.type() == Token || value.type() == String || value.type() == AssetPath) {
            if (!value.isArray() && value.isInlined()) {
                result.texts.push_back(value.type() == String ? file_.string(value.payload())
                                                              : file_.token(value.payload()));
                return result;
            }
            if (!value.isArray() || value.payload() == 0) return result;
            const auto count = arraySize(value);
            if (!count) return tl::unexpected(count.error());
            const auto indices = in_.readArray<std::uint32_t>(*count, "texts");
            if (!indices) return tl::unexpected(indices.error());
            for (const std::uint32_t index : *indices)
                result.texts.push_back(value.type() == String ? file_.string(index) : file_.token(index));
            return result;
        }
        const Layout layout = layoutOf(value.type());
        if (layout.count == 0) return result;
        result.components = layout.count;
        if (layout.component == Float || layout.component == Half) result.numbers.keepSingle();
        if (value.isArray()) {
            if (auto status = readArray(value, layout, result.numbers); !status)
                return tl::unexpected(status.error());
        } else if (value.isInlined()) {
            inlined(value, layout, result.numbers);
        } else {
            if (auto status = in_.seek(value.payload(), "a value"); !status)
                return tl::unexpected(status.error());
            if (auto status = readPlain(layout, 1, result.numbers); !status)
                return tl::unexpected(status.error());
        }
        // The real part of a quaternion stands last here, and first in text.
        if (value.type() >= Quatd && value.type() <= Quath) {
            UsdNumbers& numbers = result.numbers;
            for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
                const double real = numbers[i + 3];
                for (std::size_t k = i + 3; k > i; --k) numbers.set(k, numbers[k - 1]);
                numbers.set(i, real);
            }
        }
        return result;
    }

    /// Small values stand in the field itself: numbers of up to 32 bits, vectors and diagonals of whole
    /// numbers of 8.
    static void inlined(const UsdcValue& value, const Layout& layout, UsdNumbers& numbers) {
        const auto bits = static_cast<std::uint32_t>(value.payload());
        const auto small = [&](std::uint32_t index) {
            return static_cast<double>(static_cast<std::int8_t>(bits >> (8 * index) & 0xffu));
        };
        const std::byte* const at = reinterpret_cast<const std::byte*>(&bits);
        const bool isMatrix = value.type() >= Matrix2d && value.type() <= Matrix4d;
        if (isMatrix) {
            const std::uint32_t side = 2 + (value.type() - Matrix2d);
            for (std::uint32_t k = 0; k < side * side; ++k)
                numbers.push_back(k % (side + 1) == 0 ? small(k / (side + 1)) : 0.0);
        } else if (layout.count > 1) {
            for (std::uint32_t k = 0; k < layout.count; ++k) numbers.push_back(small(k));
        } else if (layout.component == Double) {
            numbers.push_back(double{as<float>(at)});
        } else if (layout.component == Int64) {
            numbers.push_back(as<std::int32_t>(at));
        } else if (layout.component == UInt64) {
            numbers.push_back(as<std::uint32_t>(at));
        } else {
            numbers.push_back(numberAt(at, layout.component));
        }
    }

    Result<std::uint64_t> arraySize(const UsdcValue& value) {
        if (auto status = in_.seek(value.payload(), "an array"); !status)
            return tl::unexpected(status.error());
        if (!file_.isSince(5)) {
            const auto rank = in_.read<std::uint32_t>("an array's rank");
            if (!rank) return tl::unexpected(rank.error());
        }
        if (file_.isSince(7)) return in_.read<std::uint64_t>("an array's size");
        const auto size = in_.read<std::uint32_t>("an array's size");
        if (!size) return tl::unexpected(size.error());
        return std::uint64_t{*size};
    }

    Status readArray(const UsdcValue& value, const Layout& layout, UsdNumbers& numbers) {
        constexpr std::uint64_t kFewestCompressed = 16;
        if (value.payload() == 0) return {};
        const auto size = arraySize(value);
        if (!size) return tl::unexpected(size.error());
        if (!value.isCompressed() || *size < kFewestCompressed) return readPlain(layout, *size, numbers);
        if (layout.count != 1) return error("an array of vectors is packed", "expected plain ones");
        if (layout.component == Int || layout.component == UInt || layout.component == Int64 ||
            layout.component == UInt64)
            return readPacked(layout.component, *size, numbers);
        const auto code = in_.read<char>("how an array is packed");
        if (!code) return tl::unexpected(code.error());
        if (*code == 'i') return readPacked(Int, *size, numbers);
        if (*code != 't') return error("an array is packed in an unknown way", "expected 'i' or 't'");
        const auto entries = in_.read<std::uint32_t>("the size of a table");
        if (!entries) return tl::unexpected(entries.error());
        UsdNumbers table, places;
        if (auto status = readPlain(layout, *entries, table); !status) return status;
        if (auto status = readPacked(UInt, *size, places); !status) return status;
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (places[i] >= static_cast<double>(table.size()))
                return error("a packed array refers to an entry that its table does not have");
            numbers.push_back(table[static_cast<std::size_t>(places[i])]);
        }
        return {};
    }

    Status readPlain(const Layout& layout, std::uint64_t count, UsdNumbers& numbers) {
        const std::size_t size = sizeOf(layout.component);
        if (count > in_.remaining() / (size * layout.count))
            return error(fmt::format("an array of {} elements goes beyond the end of the file", count));
        if (auto status = keep(count * layout.count); !status) return status;
        const auto bytes = file_.bytes().subspan(static_cast<std::size_t>(in_.position()),
                                                 static_cast<std::size_t>(count) * size * layout.count);
        static_cast<void>(in_.seek(in_.position() + bytes.size(), "the end of an array"));
        numbers.reserve(bytes.size() / size);
        for (std::size_t at = 0; at < bytes.size(); at += size)
            numbers.push_back(numberAt(bytes.data() + at, layout.component));
        return {};
    }

    /// Fields may name the same bytes again and again: so many numbers of all of them together.
    Status keep(std::uint64_t numbers) {
        constexpr std::uint64_t kMaxNumbers = std::uint64_t{1} << 28u;
        kept_ += numbers;
        if (numbers > kMaxNumbers || kept_ > kMaxNumbers)
            return error("its values have more numbers than are kept",
                         fmt::format("expected at most {}", kMaxNumbers));
        return {};
    }

    Status readPacked(Type component, std::uint64_t count, UsdNumbers& numbers) {
        const auto size = in_.read<std::uint64_t>("the size of packed numbers");
        if (!size) return tl::unexpected(size.error());
        if (auto status = keep(count); !status) return status;
        if (*size > in_.remaining()) return error("packed numbers go beyond the end of the file");
        const auto packed =
            file_.bytes().subspan(static_cast<std::size_t>(in_.position()), static_cast<std::size_t>(*size));
        const auto take = [&](const auto& values) -> Status {
            if (!values) return error(values.error().problem, values.error().expected);
            numbers.reserve(values->size());
            for (const auto value : *values)
                numbers.push_back(component == UInt ? static_cast<double>(static_cast<std::uint32_t>(value))
                                                    : static_cast<double>(value));
            return {};
        };
        const bool isWide = component == Int64 || component == UInt64;
        if (auto status =
                isWide ? take(unpackIntegers64(packed, count)) : take(unpackIntegers32(packed, count));
            !status)
            return status;
        return in_.seek(in_.position() + packed.size(), "the end of packed numbers");
    }

    /// Goes where a number of bytes says that what follows stands.
    Status jump() {
        const std::uint64_t start = in_.position();
        const auto offset = in_.read<std::int64_t>("a jump");
        if (!offset) return tl::unexpected(offset.error());
        return in_.seek(start + static_cast<std::uint64_t>(*offset), "samples in time");
    }

    Status readSamples(const UsdcValue& value, UsdAttribute& attribute) {
        if (value.isInlined() || value.type() != TimeSamples) return {};
        if (auto status = in_.seek(value.payload(), "samples in time"); !status) return status;
        if (auto status = jump(); !status) return status;
        const auto timesValue = in_.read<std::uint64_t>("the times of samples");
        if (!timesValue) return tl::unexpected(timesValue.error());
        const std::uint64_t behind = in_.position();
        const auto times = timesOf(UsdcValue{*timesValue});
        if (!times) return tl::unexpected(times.error());
        if (auto status = in_.seek(behind, "samples in time"); !status) return status;
        if (auto status = jump(); !status) return status;
        const auto count = in_.read<std::uint64_t>("the number of samples");
        if (!count) return tl::unexpected(count.error());
        if (*count != times->size())
            return error(fmt::format("{} samples at {} times", *count, times->size()));
        const auto values = in_.readArray<std::uint64_t>(*count, "samples");
        if (!values) return tl::unexpected(values.error());
        for (std::size_t i = 0; i < values->size(); ++i) {
            auto sample = valueOf(UsdcValue{(*values)[i]});
            if (!sample) return tl::unexpected(sample.error());
            if (!std::isfinite((*times)[i])) return error("a time of a sample is not finite");
            attribute.samples.insert_or_assign((*times)[i], std::move(*sample));
        }
        return {};
    }

    Result<std::vector<double>> timesOf(const UsdcValue& value) {
        if (value.type() == DoubleVector && !value.isInlined()) {
            if (auto status = in_.seek(value.payload(), "times"); !status)
                return tl::unexpected(status.error());
            const auto count = in_.read<std::uint64_t>("the number of times");
            if (!count) return tl::unexpected(count.error());
            return in_.readArray<double>(*count, "times");
        }
        auto times = valueOf(value);
        if (!times) return tl::unexpected(times.error());
        return times->numbers.doubles();
    }

    const UsdcFile& file_;
    ByteReader in_;
    UsdStage stage_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<const UsdcSpec*> specs_;
    std::uint64_t kept_ = 0;
};

}  // namespace

Result<UsdStage> readUsdc(const std::string& file, std::span<const std::byte> bytes) {
    const auto crate = UsdcFile::open(file, bytes);
    if (!crate) return tl::unexpected(crate.error());
    return Reader(*crate).run();
}

}  // namespace hairloom
