# SPDX-License-Identifier: GPL-3.0-or-later
"""Stands in for Unreal's module `unreal`: the classes, properties and functions that a groom's import needs, under the
names that Epic publishes for its Python API (5.1 to 5.7), with what is read-only there. Anything else is an error. The
groups of an imported file are those that a reader of the file alone finds. Runs the script that it is given."""
import runpy
import sys
import types


class Struct:
    """An object with editor properties, of which some are read-only."""
    writable, read_only = (), ()

    def __init__(self, **values):
        self._values = dict(values)

    def get_editor_property(self, name):
        if name not in self.writable + self.read_only:
            raise AttributeError(f"{type(self).__name__} has no property {name}")
        return self._values.get(name)

    def set_editor_property(self, name, value):
        if name in self.read_only:
            raise AttributeError(f"{type(self).__name__}.{name} is read-only")
        if name not in self.writable:
            raise AttributeError(f"{type(self).__name__} has no property {name}")
        self._values[name] = value


class Vector:
    def __init__(self, x=0.0, y=0.0, z=0.0):
        self.x, self.y, self.z = float(x), float(y), float(z)


class GroomConversionSettings(Struct):
    writable = ("rotation", "scale")


class GroomImportOptions(Struct):
    writable, read_only = ("conversion_settings",), ("interpolation_settings",)


class HairStrandsFactory(Struct):
    pass


class AssetImportTask(Struct):
    writable = ("automated", "destination_name", "destination_path", "factory", "filename", "options",
                "replace_existing", "replace_existing_settings", "save")


class HairGroupInfoWithVisibility(Struct):
    writable = ("is_visible",)
    read_only = ("group_id", "group_name", "max_curve_length", "num_curves", "num_curve_vertices", "num_guides",
                 "num_guide_vertices")


class GroomAsset(Struct):
    writable = ("hair_groups_info", "hair_groups_materials")


class SkeletalMesh(Struct):
    pass


class GroomBindingAsset(Struct):
    writable = ("groom", "source_skeletal_mesh", "target_skeletal_mesh")
    read_only = ("group_infos", "matching_section", "num_interpolation_points")


class Project:
    """What Unreal would have: assets by path, and what was said."""

    def __init__(self, groups):
        self.assets = {"/Game/Characters/SK_Head": SkeletalMesh()}
        self.saved, self.said, self.warned = [], [], []
        self.tasks = []
        self.groups = groups

    def import_tasks(self, tasks):
        for task in tasks:
            self.tasks.append(task)
            open(task.get_editor_property("filename"), "rb").close()
            if not isinstance(task.get_editor_property("factory"), HairStrandsFactory):
                raise TypeError("the factory of Alembic grooms is HairStrandsFactory")
            groom = GroomAsset(hair_groups_info=[
                HairGroupInfoWithVisibility(group_id=i, group_name=name, num_curves=hairs, num_guides=guides)
                for i, name, hairs, guides in self.groups])
            path = task.get_editor_property("destination_path") + "/" + task.get_editor_property("destination_name")
            self.assets[path] = groom

    def bind(self, desired_package_path, groom_asset, skeletal_mesh, num_interpolation_points=100,
             source_skeletal_mesh_for_transfer=None, matching_section=0):
        binding = GroomBindingAsset(groom=groom_asset, target_skeletal_mesh=skeletal_mesh,
                                    source_skeletal_mesh=source_skeletal_mesh_for_transfer,
                                    num_interpolation_points=num_interpolation_points,
                                    matching_section=matching_section)
        self.assets[desired_package_path] = binding
        return binding


def module_of(project):
    unreal = types.ModuleType("unreal")
    for known in (Vector, GroomConversionSettings, GroomImportOptions, HairStrandsFactory, AssetImportTask, GroomAsset,
                  SkeletalMesh, GroomBindingAsset):
        setattr(unreal, known.__name__, known)
    unreal.AssetToolsHelpers = types.SimpleNamespace(
        get_asset_tools=lambda: types.SimpleNamespace(import_asset_tasks=project.import_tasks))
    unreal.EditorAssetLibrary = types.SimpleNamespace(
        does_asset_exist=lambda path: path in project.assets, load_asset=project.assets.get,
        delete_asset=lambda path: project.assets.pop(path) is not None,
        save_loaded_asset=lambda asset, only_if_is_dirty=True: project.saved.append(asset) or True)
    unreal.GroomLibrary = types.SimpleNamespace(create_new_groom_binding_asset_with_path=project.bind)
    unreal.log, unreal.log_warning = project.said.append, project.warned.append
    return unreal


def run(script, words, groups):
    """The project after the script has run in it."""
    project = Project(groups)
    sys.modules["unreal"] = module_of(project)
    before, sys.argv = sys.argv, [script, *words]
    try:
        runpy.run_path(script, run_name="__main__")
    finally:
        sys.argv = before
    return project


def main():
    """unreal_stub.py SCRIPT ID:NAME:HAIRS:GUIDES… runs it and prints what came of it; exits 1 on a warning."""
    groups = []
    for word in sys.argv[2:]:
        number, name, hairs, guides = word.split(":")
        groups.append((int(number), name, int(hairs), int(guides)))
    project = run(sys.argv[1], ["--mesh", "/Game/Characters/SK_Head", "--folder", "/Game/Test/"], groups)
    conversion = project.tasks[0].get_editor_property("options").get_editor_property("conversion_settings")
    rotation, scale = (conversion.get_editor_property(name) for name in ("rotation", "scale"))
    print("rotation", rotation.x, rotation.y, rotation.z, "scale", scale.x, scale.y, scale.z)
    for path, asset in sorted(project.assets.items()):
        print(path, type(asset).__name__)
    for line in project.warned:
        print("warning:", line)
    try:
        run(sys.argv[1], ["--mesh", "/Game/Missing"], groups)
    except SystemExit as ended:
        print("refused:", ended)
    return 1 if project.warned else 0


if __name__ == "__main__":
    sys.exit(main())
