// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/src/groom.h"

#include <fmt/format.h>
#include <nanobind/make_iterator.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "core/documents/hair_import.h"
#include "core/documents/open.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/layers_json.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/validate.h"
#include "python/src/arrays.h"
#include "python/src/frame.h"
#include "python/src/json_values.h"

namespace hairloom::python {
namespace {

using namespace nb::literals;

/// The attributes of points or of strands of a groom, hairloom.Attributes.
struct PyAttributes {
    PyGroom& of;
    bool ofPoints;

    AttributeSet& set() const { return ofPoints ? of.groom.pointAttributes : of.groom.strandAttributes; }
    std::size_t count() const { return ofPoints ? of.groom.pointCount() : of.groom.strandCount(); }
};

/// What `read` gives of a groom that no other thread is changing.
template <class Read>
auto whileFree(PyGroom& groom, const Read& read) {
    const Use use(groom.inUse, kTheGroom);
    return read(groom.groom);
}

std::size_t strandCount(PyGroom& groom) {
    return whileFree(groom, [](const Groom& of) { return of.strandCount(); });
}
std::size_t pointCount(PyGroom& groom) {
    return whileFree(groom, [](const Groom& of) { return of.pointCount(); });
}
std::size_t guideCount(PyGroom& groom) {
    return whileFree(groom, [](const Groom& of) { return of.guideCount(); });
}

std::string described(PyGroom& groom) {
    // A debugger asks at any time.
    if (groom.inUse) return "<hairloom.Groom: in use by another thread>";
    return fmt::format("<hairloom.Groom: {} strands, {} points>", strandCount(groom), pointCount(groom));
}

nb::object viewOfData(const AttributeData& data) {
    return std::visit(
        [](const auto& array) -> nb::object {
            using Array = std::decay_t<decltype(array)>;
            const auto shared = std::make_shared<Array>(array);
            return viewOf(shared->view(), shared);
        },
        data);
}

nb::object attribute(const PyAttributes& attributes, const std::string& name) {
    const Use use(attributes.of.inUse, kTheGroom);
    const auto& all = attributes.set().all();
    const auto found = all.find(name);
    if (found == all.end()) throw nb::key_error(name.c_str());
    return viewOfData(found->second);
}

/// What an attribute of that name and type may be set to.
template <class T>
bool setAs(const PyAttributes& attributes, const std::string& name, nb::handle values, nb::dlpack::dtype type,
           std::size_t components) {
    if (type != nb::dtype<typename Element<T>::Scalar>() || components != Element<T>::kCount) return false;
    const Input<T> input(name.c_str(), values);
    if (input.held.size != attributes.count())
        raiseArgument(
            name, fmt::format("has {} rows", input.held.size),
            fmt::format("{}, one for each {}", attributes.count(), attributes.ofPoints ? "point" : "strand"));
    // On a copy, so that a groom that would no longer hold together is as it was.
    Groom changed = attributes.of.groom;
    if (attributes.ofPoints && name == attribute::kPosition) dropOperators(changed);
    (attributes.ofPoints ? changed.pointAttributes : changed.strandAttributes).set(name, input.copy());
    unwrap(checkStructure(changed));
    attributes.of.groom = std::move(changed);
    return true;
}

void setAttribute(const PyAttributes& attributes, const std::string& name, nb::handle values) {
    const Use use(attributes.of.inUse, kTheGroom);
    nb::ndarray<nb::ro, nb::device::cpu> array;
    const char* const types =
        "a contiguous array of float32, (n,) to (n, 4), or of int32, uint32 or uint8, (n,)";
    if (!nb::ndarray_check(values) || !nb::try_cast(values, array, false))
        raiseArgument(name, fmt::format("is {}", nb::type_name(values.type()).c_str()), types);
    const std::size_t components = array.ndim() == 2 ? array.shape(1) : array.ndim() == 1 ? 1 : 0;
    const auto type = array.dtype();
    if (attributes.set().has(name)) {
        // It keeps its type: what reads it relies on that.
        std::visit(
            [&](const auto& present) {
                using T = std::decay_t<decltype(present[0])>;
                setAs<T>(attributes, name, values, nb::dtype<typename Element<T>::Scalar>(),
                         Element<T>::kCount);
            },
            attributes.set().all().find(name)->second);
        return;
    }
    const bool set = setAs<float>(attributes, name, values, type, components) ||
                     setAs<Vec2f>(attributes, name, values, type, components) ||
                     setAs<Vec3f>(attributes, name, values, type, components) ||
                     setAs<Vec4f>(attributes, name, values, type, components) ||
                     setAs<std::int32_t>(attributes, name, values, type, components) ||
                     setAs<std::uint32_t>(attributes, name, values, type, components) ||
                     setAs<std::uint8_t>(attributes, name, values, type, components);
    if (!set) raiseArgument(name, "has another type or shape", types);
}

std::vector<std::string> namesOf(const PyAttributes& attributes) {
    const Use use(attributes.of.inUse, kTheGroom);
    std::vector<std::string> names;
    for (const auto& [name, data] : attributes.set().all()) names.push_back(name);
    return names;
}

std::unique_ptr<PyGroom> makeOfArrays(nb::handle positions, nb::handle offsets) {
    const Input<Vec3f> points("positions", positions);
    const Input<std::uint32_t> starts("offsets", offsets);
    const auto values = starts.values();
    if (values.empty() || values.front() != 0 || values.back() != points.held.size ||
        !std::ranges::is_sorted(values))
        raiseArgument(
            "offsets",
            values.empty() ? "is empty" : fmt::format("run from {} to {}", values.front(), values.back()),
            fmt::format("ascending numbers from 0 to the {} points", points.held.size));
    auto groom = std::make_unique<PyGroom>(makeGroom(starts.copy(), points.copy()));
    unwrap(checkStructure(groom->groom));
    return groom;
}

nb::object positions(PyGroom& groom) {
    return attribute({groom, true}, std::string(attribute::kPosition));
}
void setPositions(PyGroom& groom, nb::handle values) {
    setAttribute({groom, true}, std::string(attribute::kPosition), values);
}
nb::object offsets(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    const auto shared = std::make_shared<CowArray<std::uint32_t>>(groom.groom.offsets);
    return viewOf(shared->view(), shared);
}

nb::dict runText(PyGroom& groom, const std::string& text, const std::string& file) {
    const Use use(groom.inUse, kTheGroom);
    auto report = withoutGil([&]() -> Result<ScriptReport> {
        const auto script = parseDocumentScript(file, text);
        if (!script) return tl::unexpected(script.error());
        return runScript(*script, groom.groom);
    });
    const ScriptReport done = unwrap(std::move(report));
    nb::dict answer;
    answer["strokes"] = done.strokes;
    answer["touched_strands"] = done.touchedStrands;
    return answer;
}

nb::dict runSteps(PyGroom& groom, nb::handle operations) {
    nb::dict script;
    script["hairloom_script"] = kScriptVersion;
    script["operations"] = operations;
    return runText(groom, jsonOf(script), "script");
}

/// {"op": operation, **fields}, as a script has it.
nb::dict apply(PyGroom& groom, const std::string& operation, const nb::kwargs& fields) {
    if (fields.contains("op"))
        raiseArgument("op", "is given", "fields of the operation, whose name comes first");
    nb::dict step;
    step["op"] = operation;
    step.update(fields);
    nb::list steps;
    steps.append(step);
    return runSteps(groom, steps);
}

nb::dict runFile(PyGroom& groom, const std::filesystem::path& path) {
    return runText(groom, unwrap(readTextFile(path, kMaxJsonBytes)), path.string());
}

nb::object settings(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    const nlohmann::ordered_json all{{"simulation", toJson(groom.groom.simulation)},
                                     {"material", toJson(groom.groom.material)},
                                     {"shadows", toJson(groom.groom.shadows)},
                                     {"interpolation", toJson(groom.groom.interpolation)}};
    return valueOfJson(all.dump());
}

void configure(PyGroom& groom, nb::handle sections) {
    const std::string text = jsonOf(sections);
    const Use use(groom.inUse, kTheGroom);
    const auto json = unwrap(parseJson("settings", text));
    Groom changed = groom.groom;
    unwrap(applySettings(json, "settings", changed));
    groom.groom = std::move(changed);
}

std::unique_ptr<PyGroom> copied(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    return std::make_unique<PyGroom>(groom.groom);
}

nb::list findings(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    nb::list rows;
    for (const Finding& finding : withoutGil([&] { return validate(groom.groom); })) {
        nb::dict row;
        row["severity"] = std::string(severityName(finding.severity));
        row["what"] = finding.what;
        row["where"] = finding.where;
        row["fix"] = finding.fix;
        rows.append(row);
    }
    return rows;
}

}  // namespace

void bindGroom(nb::module_& module) {
    nb::class_<PyAttributes>(
        module, "Attributes",
        "Named arrays, one row for each point or strand. Reading gives a read-only view, without a copy, "
        "of what the array is now. Assign an array to change or add an attribute.")
        .def("__getitem__", &attribute, "name"_a,
             nb::sig("def __getitem__(self, name: str) -> numpy.typing.NDArray[typing.Any]"),
             "A read-only view. Raises KeyError where there is no attribute of this name.")
        .def("__setitem__", &setAttribute, "name"_a, "values"_a.none(),
             nb::sig("def __setitem__(self, name: str, values: object) -> None"),
             "Copies an array in: contiguous float32 of shape (n,) to (n, 4), or int32, uint32 or uint8 of "
             "shape (n,). NumPy and "
             "DLPack. An attribute keeps its type.\n\nRaises ArgumentError for another type, shape or number "
             "of rows, and for "
             "numbers that are not finite.")
        .def(
            "__delitem__",
            [](const PyAttributes& attributes, const std::string& name) {
                const Use use(attributes.of.inUse, kTheGroom);
                if (!attributes.set().has(name)) throw nb::key_error(name.c_str());
                if (attributes.ofPoints && name == attribute::kPosition)
                    raiseArgument(name, "cannot be deleted", "another attribute");
                attributes.set().erase(name);
            },
            "name"_a, "Raises KeyError where there is no attribute of this name.")
        .def("__contains__",
             [](const PyAttributes& attributes, const std::string& name) {
                 const Use use(attributes.of.inUse, kTheGroom);
                 return attributes.set().has(name);
             })
        .def("__len__",
             [](const PyAttributes& attributes) {
                 const Use use(attributes.of.inUse, kTheGroom);
                 return attributes.set().all().size();
             })
        .def(
            "__iter__",
            [](const PyAttributes& attributes) { return nb::iter(nb::cast(namesOf(attributes))); },
            nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"))
        .def("keys", &namesOf, "Names in alphabetical order.");

    nb::class_<PyGroom> type(module, "Groom",
                             "Strands on a scalp with their attributes, layers, operators and settings. "
                             "Lengths are in metres, Y is up. "
                             "One thread uses a groom at a time: another gets BusyError. Copies are cheap.");
    type.def(nb::new_(&makeOfArrays), "positions"_a.none(), "offsets"_a.none(),
             "Strands without a scalp.\n\npositions: float32 (n, 3), metres, root first. offsets: uint32 "
             "(strands + 1,), strand s "
             "owns the points offsets[s] to offsets[s + 1].\n\nRaises ArgumentError for other types or "
             "shapes, positions that are "
             "not finite, and offsets that do not ascend from 0 to n.")
        .def_static(
            "open",
            [](const std::filesystem::path& path) {
                auto groom = withoutGil([&] { return openGroom(path.string()); });
                return std::make_unique<PyGroom>(unwrap(std::move(groom)));
            },
            "path"_a, nb::sig("def open(path: str | os.PathLike[str]) -> Groom"),
            "A project, or a hair file of any supported format.\n\nRaises Error with file and place for a "
            "file that cannot be read.")
        .def(
            "save",
            [](PyGroom& groom, const std::filesystem::path& path) {
                const Use use(groom.inUse, kTheGroom);
                unwrap(withoutGil([&] { return saveProject(groom.groom, path); }));
            },
            "path"_a, nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
            "Writes a project. Replaces the file at once or not at all.\n\nRaises Error where it cannot be "
            "written.")
        .def("copy", &copied, "A groom of its own. The two share arrays until one of them changes.")
        .def("__copy__", &copied)
        .def(
            "__deepcopy__", [](PyGroom& groom, nb::handle) { return copied(groom); }, "memo"_a,
            nb::sig("def __deepcopy__(self, memo: dict[int, typing.Any]) -> Groom"))
        .def_prop_ro("strand_count", &strandCount, "Number of strands.")
        .def_prop_ro("point_count", &pointCount, "Number of points of all strands.")
        .def_prop_ro("guide_count", &guideCount, "Number of strands that are simulated.")
        .def_prop_rw("positions", &positions, &setPositions,
                     nb::for_getter(nb::sig("def positions(self) -> numpy.typing.NDArray[numpy.float32]")),
                     nb::for_setter(nb::sig("def positions(self, values: object) -> None")),
                     nb::for_setter("values"_a.none()),
                     "float32 (points, 3), metres, in the scalp's rest space. A read-only view without a "
                     "copy. Assign an array of the "
                     "same shape to move points. Operators of the groom no longer apply to points that you "
                     "have moved.")
        .def_prop_ro(
            "offsets", &offsets, nb::sig("def offsets(self) -> numpy.typing.NDArray[numpy.uint32]"),
            "uint32 (strands + 1,): strand s owns the points offsets[s] to offsets[s + 1]. A read-only view.")
        .def_prop_ro(
            "points",
            [](PyGroom& groom) {
                return PyAttributes{groom, true};
            },
            nb::keep_alive<0, 1>(),
            "Attributes of points: position, radius (m), colour (linear RGB) and others.")
        .def_prop_ro(
            "strands",
            [](PyGroom& groom) {
                return PyAttributes{groom, false};
            },
            nb::keep_alive<0, 1>(),
            "Attributes of strands: id, root_uv, root_triangle, layer, group, guide and others.")
        .def("apply", &apply, "operation"_a, "fields"_a,
             nb::sig("def apply(self, operation: str, /, **fields: typing.Any) -> dict[str, int]"),
             "Runs an operation of scripts, or a stroke of a brush ('stroke'), with its fields as keywords: "
             "apply('curl', radius=0.01). docs/reference.md lists all. Returns strokes and touched_strands. "
             "Releases the GIL.\n\n"
             "Raises Error for an unknown operation or field and for a value out of range. The groom is then "
             "unchanged.")
        .def("run", &runSteps, "operations"_a,
             nb::sig("def run(self, operations: collections.abc.Sequence[collections.abc.Mapping[str, "
                     "typing.Any]]) -> dict[str, "
                     "int]"),
             "Runs operations in order, each a dict with 'op'. All of them or, on Error, none.")
        .def("run_script", &runFile, "path"_a,
             nb::sig("def run_script(self, path: str | os.PathLike[str]) -> dict[str, int]"),
             "Runs a script file (docs/formats/script.md).")
        .def_prop_ro("settings", &settings, nb::sig("def settings(self) -> dict[str, dict[str, typing.Any]]"),
                     "A copy of the settings: 'simulation', 'material' and 'interpolation', with units as "
                     "docs/reference.md has them.")
        .def("configure", &configure, "settings"_a,
             nb::sig("def configure(self, settings: collections.abc.Mapping[str, "
                     "collections.abc.Mapping[str, typing.Any]]) -> None"),
             "Changes settings: configure({'simulation': {'windSpeed': 4}}). What you leave out keeps its "
             "value.\n\nRaises Error for an "
             "unknown name or a value out of range. The groom is then unchanged.")
        .def("validate", &findings, nb::sig("def validate(self) -> list[dict[str, str]]"),
             "What a consumer would trip over, with severity, what, where and fix. An empty list if nothing.")
        .def("render", &render, "size"_a = std::pair(1024u, 1024u), "camera"_a = "three-quarter",
             "view"_a = "", "passes"_a = 8u, "transparent"_a = false, "frame"_a.none() = nb::none(),
             nb::sig("def render(self, size: tuple[int, int] = (1024, 1024), camera: str = 'three-quarter', "
                     "view: str | os.PathLike[str] = '', passes: "
                     "int = 8, transparent: bool = False, frame: Frame | None = None) -> "
                     "numpy.typing.NDArray[numpy.uint8]"),
             "An image, uint8 (height, width, 4), sRGB and alpha, rows from the top. Drawn on a GPU if there "
             "is one, otherwise by the "
             "software renderer. Releases the GIL.\n\nsize: width and height in pixels. camera: front, back, "
             "left, right, "
             "three-quarter, top or bottom. view: a JSON file with camera, lights and materials. passes: "
             "images that are averaged, 1 "
             "to 1024. frame: of simulate(), in place of the hair at rest.\n\nRaises ArgumentError for "
             "values out of range.")
        .def("__len__", &strandCount)
        .def("__repr__", &described);
    bindScene(type);
    bindSimulate(type);
    bindLiveOf(type);
}

}  // namespace hairloom::python
