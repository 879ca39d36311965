// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/unreal_script.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

namespace hairloom {
namespace {

/// Everything but the values at its head, which come from the export.
constexpr const char* kScript = R"PY(

def import_groom(folder, replace):
    """The groom as an asset. Rotation and scale make Unreal's axes and centimetres of the file's."""
    conversion = unreal.GroomConversionSettings()
    conversion.set_editor_property("rotation", unreal.Vector(*ROTATION))
    conversion.set_editor_property("scale", unreal.Vector(*SCALE))
    options = unreal.GroomImportOptions()
    options.set_editor_property("conversion_settings", conversion)
    path = folder + "/" + ASSET
    if unreal.EditorAssetLibrary.does_asset_exist(path) and not replace:
        raise SystemExit(path + " is there already; --replace imports over it, --folder takes another place")
    task = unreal.AssetImportTask()
    task.set_editor_property("filename", FILE)
    task.set_editor_property("destination_path", folder)
    task.set_editor_property("destination_name", ASSET)
    task.set_editor_property("automated", True)
    task.set_editor_property("replace_existing", replace)
    task.set_editor_property("save", True)
    task.set_editor_property("factory", unreal.HairStrandsFactory())
    task.set_editor_property("options", options)
    unreal.AssetToolsHelpers.get_asset_tools().import_asset_tasks([task])
    groom = unreal.EditorAssetLibrary.load_asset(path)
    if not isinstance(groom, unreal.GroomAsset):
        raise SystemExit(FILE + " did not become a groom; enable the plugins Groom and Alembic Groom Importer")
    return groom


def check_groups(groom):
    """Whether Unreal has the groups, hairs and guides that were written. True where it has."""
    found = {int(group.get_editor_property("group_id")): group
             for group in groom.get_editor_property("hair_groups_info")}
    right = True
    for wanted in GROUPS:
        group = found.get(wanted["id"])
        if group is None:
            unreal.log_warning("group {id} ({name}) is missing".format(**wanted))
            right = False
            continue
        name = str(group.get_editor_property("group_name"))
        curves = int(group.get_editor_property("num_curves"))
        guides = int(group.get_editor_property("num_guides"))
        unreal.log("group {}: {}, {} hairs, {} guides".format(wanted["id"], name, curves, guides))
        if wanted["name"] and name != wanted["name"]:
            unreal.log_warning("group {id} was written as '{name}'".format(**wanted) + ", and is '" + name + "'")
            right = False
        if wanted["guides"] and guides != wanted["guides"]:
            unreal.log_warning("group {id} was written with {guides} guides".format(**wanted))
            right = False
    return right


def bind(groom, folder, mesh_path, authored_path, replace):
    """The binding that makes the groom follow a skeletal mesh."""
    mesh = unreal.EditorAssetLibrary.load_asset(mesh_path)
    if not isinstance(mesh, unreal.SkeletalMesh):
        raise SystemExit(mesh_path + " is no skeletal mesh")
    authored = unreal.EditorAssetLibrary.load_asset(authored_path) if authored_path else None
    if authored_path and not isinstance(authored, unreal.SkeletalMesh):
        raise SystemExit(authored_path + " is no skeletal mesh")
    path = folder + "/" + ASSET + "_Binding"
    if unreal.EditorAssetLibrary.does_asset_exist(path):
        if not replace:
            raise SystemExit(path + " is there already; --replace makes it again")
        unreal.EditorAssetLibrary.delete_asset(path)
    binding = unreal.GroomLibrary.create_new_groom_binding_asset_with_path(
        path, groom, mesh, 100, authored, 0)
    if binding is None:
        raise SystemExit("Unreal made no binding of " + ASSET + " to " + mesh_path)
    unreal.EditorAssetLibrary.save_loaded_asset(binding)
    unreal.log("bound to " + mesh_path + ": " + path)
    return binding


def main(words):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", default="/Game/Hair", help="where the assets go (default: /Game/Hair)")
    parser.add_argument("--mesh", help="skeletal mesh to bind to, such as /Game/Characters/SK_Head")
    parser.add_argument("--authored-on", help="skeletal mesh that the hair was made on, if that is another")
    parser.add_argument("--replace", action="store_true", help="import over what is there")
    asked = parser.parse_args(words)
    folder = asked.folder.rstrip("/")
    groom = import_groom(folder, asked.replace)
    right = check_groups(groom)
    if asked.mesh:
        bind(groom, folder, asked.mesh, asked.authored_on, asked.replace)
    if MOVES:
        unreal.log("the file moves: drag it into the content browser and tick Import Groom Cache for its motion")
    unreal.log(ASSET + " is imported" + ("" if right else "; read the warnings above"))
    return right


if __name__ == "__main__":
    main(sys.argv[1:])
)PY";

/// A text as Python has it; JSON's are Python's, too.
std::string literal(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

struct Group {
    std::string name;
    std::size_t curves = 0, guides = 0;
};

/// As Unreal sorts them: by the number that the file has.
std::map<std::int32_t, Group> groupsOf(const Groom& groom, const PreparedStrands& strands,
                                       std::span<const ExportedAttribute> attributes) {
    const auto find = [&](std::string_view name) -> const ExportedAttribute* {
        for (const ExportedAttribute& one : attributes) {
            if (one.name == name && !one.perPoint && one.whole.size() == strands.strandCount()) return &one;
        }
        return nullptr;
    };
    const ExportedAttribute* const ids = find("groom_group_id");
    const ExportedAttribute* const guides = find("groom_guide");
    const std::vector<std::string> names = unrealGroupNames(groom, strands);
    std::map<std::int32_t, Group> groups;
    for (std::size_t s = 0; s < strands.strandCount(); ++s) {
        Group& group = groups[ids ? ids->whole[s] : 0];
        if (group.curves + group.guides == 0 && !names.empty()) group.name = names[s];
        ++(guides && guides->whole[s] != 0 ? group.guides : group.curves);
    }
    return groups;
}

std::string groupsInPython(const std::map<std::int32_t, Group>& groups) {
    std::string text = "[";
    for (const auto& [id, group] : groups)
        text += fmt::format("\n    {{\"id\": {}, \"name\": {}, \"hairs\": {}, \"guides\": {}}},", id,
                            literal(group.name), group.curves, group.guides);
    return text + "\n]";
}

}  // namespace

std::filesystem::path unrealScriptPath(const std::filesystem::path& asset) {
    std::filesystem::path path = asset;
    path.replace_filename(asset.stem().string() + "_unreal.py");
    return path;
}

std::string unrealScript(const Groom& groom, const PreparedStrands& strands,
                         std::span<const ExportedAttribute> attributes, const StrandExportOptions& options,
                         const std::filesystem::path& asset) {
    constexpr double kCentimetre = 0.01;
    const double scale = static_cast<double>(options.metresPerUnit) / kCentimetre;
    // Names of Unreal's assets have letters, digits and underscores.
    const std::string name = NameGiver(isLegalInUsd).give(asset.stem().string());
    std::string text = fmt::format(
        "# Imports {0} into Unreal. Written beside it by Hairloom.\n"
        "# In the editor: Tools > Execute Python Script, with the plugins Groom, Alembic Groom Importer and\n"
        "# Python Editor Script Plugin. With a character, in the editor's command line (Cmd):\n"
        "#   py {1} --mesh /Game/Characters/SK_Head\n",
        literal(asset.filename().string()), literal(unrealScriptPath(asset).filename().string()));
    text += fmt::format(
        "\"\"\"Imports a groom with the settings that its file needs, and binds it to a skeletal "
        "mesh.\"\"\"\n"
        "import argparse\nimport os\nimport sys\n\nimport unreal\n\n"
        "FILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), {})\nASSET = {}\n",
        literal(asset.filename().string()), literal(name));
    text += fmt::format("ROTATION = ({:.1f}, 0.0, 0.0)\nSCALE = ({:.6g}, {:.6g}, {:.6g})\nMOVES = {}\n",
                        options.up == UpAxis::Y ? 90.0 : 0.0, scale, -scale, scale,
                        strands.frames.empty() ? "False" : "True");
    text += "GROUPS = " + groupsInPython(groupsOf(groom, strands, attributes)) + "\n";
    return text + kScript;
}

}  // namespace hairloom
