# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair that follows the scene: one simulation for each Curves object, moved by a handler of frame changes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from bpy.app.handlers import persistent

from . import convert
from .axes import TO_Y_UP, TO_Z_UP, to_y_up_metres
from .bodies import Bodies
from .cache import Cache
from .module import Problem, hairloom

REST = "hairloom_rest"
SWITCHED = "hairloom_off: "
# Frames that playback may drop. The hair moves through them. A longer jump starts it anew.
MOST_DROPPED = 8
LONGEST_STEP = 0.1  # seconds, of the module

@dataclass
class State:
    """Of the scene at a frame, in metres, Y up, world."""

    scalp: np.ndarray | None
    head: np.ndarray | None
    spheres: np.ndarray
    bones: np.ndarray | None

    def between(self, later: State, share: float) -> State:
        """What lies between the two: places go straight, which small turns bear."""

        def mixed(a: np.ndarray | None, b: np.ndarray | None) -> np.ndarray | None:
            if share == 1 or a is None or b is None or a.shape != b.shape:
                return b
            return (a + (b - a) * np.float32(share)).astype(np.float32)

        # A head must stay a rigid motion.
        return State(mixed(self.scalp, later.scalp), later.head, mixed(self.spheres, later.spheres), mixed(self.bones, later.bones))

    def given(self) -> dict[str, Any]:
        return {"scalp": self.scalp, "head": self.head, "spheres": self.spheres, "bones": self.bones}


@dataclass
class Live:
    """A simulation of an object. What Blender owns is looked up in each frame, since undo replaces it."""

    simulation: Any
    bodies: Bodies
    metres: float  # in a unit of the scene
    frame: int
    state: State
    surface: str | None


_running: dict[int, Live] = {}


def settings(obj: bpy.types.Object) -> Any:
    return obj.data.hairloom


def _evaluated_vertices(surface: bpy.types.Object, graph: bpy.types.Depsgraph, expected: int) -> np.ndarray:
    mesh = surface.evaluated_get(graph).data
    count = len(mesh.vertices)
    if count != expected:
        raise Problem(
            f"The surface '{surface.name}' has {count} vertices after its modifiers and {expected} before: "
            "expected modifiers that keep them, as an armature does"
        )
    points = np.empty(count * 3, np.float32)
    mesh.attributes["position"].data.foreach_get("vector", points)
    return points.reshape(-1, 3)


def _spheres(obj: bpy.types.Object, graph: bpy.types.Depsgraph, metres: float) -> tuple[np.ndarray, list[bpy.types.Object]]:
    """Centres and radii, and whose they are."""
    rows, balls = [], []
    for ball in convert.spheres_in(settings(obj).colliders):
        now = ball.evaluated_get(graph).matrix_world
        radius = ball.empty_display_size * max(map(abs, now.to_scale())) * metres
        # One that is scaled to nothing keeps its row: capsules name balls by their rows.
        rows.append((*(TO_Y_UP @ np.array(now.translation) * metres), max(radius, 1e-6)))
        balls.append(ball)
    return np.array(rows, np.float32).reshape(-1, 4), balls


def _state(obj: bpy.types.Object, live_bodies: Bodies, surface: bpy.types.Object | None, metres: float, graph: bpy.types.Depsgraph) -> State:
    scalp = head = None
    if surface is not None:
        m = to_y_up_metres(surface.evaluated_get(graph).matrix_world, metres)
        points = _evaluated_vertices(surface, graph, len(surface.data.vertices))
        scalp = points @ m[:3, :3].T.astype(np.float32)
        scalp += m[:3, 3].astype(np.float32)
    else:
        location, rotation, _ = obj.evaluated_get(graph).matrix_world.decompose()
        head = np.eye(4, dtype=np.float32)
        head[:3, :3] = TO_Y_UP @ np.array(rotation.to_matrix()) @ TO_Z_UP
        head[:3, 3] = TO_Y_UP @ np.array(location) * metres
    return State(scalp, head, _spheres(obj, graph, metres)[0], live_bodies.matrices(graph))


def _make(scene: bpy.types.Scene, obj: bpy.types.Object, graph: bpy.types.Depsgraph) -> Live:
    """The hair at rest on the scene as it is."""
    convert.checked(obj)
    metres = scene.unit_settings.scale_length
    surface = convert.surface_of(obj)
    groom, _ = convert.to_groom(scene, obj)
    if surface is not None:
        # The surface at rest carries the hair, in its own size in the world. Where it is and how it turns comes with each frame.
        at, corners, starts = convert.mesh_arrays(surface.data)
        m = to_y_up_metres(surface.matrix_world, metres)
        rest = (at @ m[:3, :3].T + m[:3, 3]).astype(np.float32)
        mine = to_y_up_metres(obj.matrix_world, metres)
        rest_attribute = obj.data.attributes.get(REST)
        local = convert.read(rest_attribute) if rest_attribute is not None else convert.positions_of(obj.data)
        groom.positions = np.ascontiguousarray(local @ mine[:3, :3].T + mine[:3, 3], np.float32)
        groom.set_scalp(rest, corners, starts)
    own = settings(obj)
    bodies = Bodies.of(scene, obj, surface, metres)
    # Each frame has them where they are then. What is joined is so from the start.
    groom.capsules = np.empty((0, 2), np.uint32)
    groom.spheres, balls = _spheres(obj, graph, metres)
    groom.capsules = convert.capsules_between(balls)
    bodies.bake(groom, own.cell / 1000)
    state = _state(obj, bodies, surface, metres, graph)
    live = Live(groom.live(**state.given()), bodies, metres, scene.frame_current, state, surface.name if surface else None)
    g = scene.gravity if scene.use_gravity else (0, 0, 0)
    live.simulation.set_settings({"gravity": [g[0], g[2], -g[1]]})
    _pre_roll(scene, obj, live)
    return live


def _pre_roll(scene: bpy.types.Scene, obj: bpy.types.Object, live: Live) -> None:
    for _ in range(settings(obj).pre_roll):
        _advance(scene, obj, live, live.state)


def _reset(scene: bpy.types.Scene, obj: bpy.types.Object, live: Live, to: State) -> None:
    live.simulation.reset(**to.given())
    live.state = to
    _pre_roll(scene, obj, live)


def _advance(scene: bpy.types.Scene, obj: bpy.types.Object, live: Live, to: State, frames: int = 1) -> None:
    seconds = frames * scene.render.fps_base / scene.render.fps
    steps = max(frames, math.ceil(seconds / LONGEST_STEP))
    x, y, z = settings(obj).wind
    wind = (x, z, -y) if x or y or z else None
    for i in range(1, steps + 1):
        live.simulation.step(seconds / steps, **live.state.between(to, i / steps).given(), wind=wind)
    live.state = to


def _show(obj: bpy.types.Object, live: Live, graph: bpy.types.Depsgraph) -> None:
    """Points of the world as the object has them."""
    m = np.array(obj.evaluated_get(graph).matrix_world.inverted(), np.float64)
    turn = (m[:3, :3] @ TO_Z_UP / live.metres).astype(np.float32)
    points = live.simulation.positions() @ turn.T
    points += m[:3, 3].astype(np.float32)
    convert.set_positions(obj.data, points)
    obj.data.update_tag()


def _step(scene: bpy.types.Scene, obj: bpy.types.Object, graph: bpy.types.Depsgraph) -> None:
    key = obj.session_uid
    live = _running.get(key)
    frame = scene.frame_current
    if live is None:
        live = _running[key] = _make(scene, obj, graph)
    elif frame != live.frame:
        surface = obj.data.surface
        if (surface.name if surface else None) != live.surface:
            raise Problem("The surface was changed: start the simulation again")
        to = _state(obj, live.bodies, surface, live.metres, graph)
        if live.frame < frame <= live.frame + 1 + MOST_DROPPED:
            _advance(scene, obj, live, to, frame - live.frame)
        else:
            _reset(scene, obj, live, to)
        live.frame = frame
    _show(obj, live, graph)


def simulated(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    return [one for one in scene.objects if one.type == "CURVES" and settings(one).mode != "OFF"]


@persistent
def on_frame(scene: bpy.types.Scene, graph: bpy.types.Depsgraph | None = None) -> None:
    for obj in simulated(scene):
        own = settings(obj)
        try:
            if own.mode == "LIVE":
                _step(scene, obj, graph or bpy.context.evaluated_depsgraph_get())
            else:
                Cache.of(obj).show(obj, scene.frame_current)
            own.status = ""
        except Exception as error:  # noqa: BLE001, or Blender would raise it again in each frame
            # A handler cannot report. The panel shows it, and the hair goes back to rest.
            own.status = str(error)
            print(f"Hairloom: {obj.name}: {error}")
            stop(obj)


@persistent
def forget(*_: object) -> None:
    """Of what was loaded or undone: simulations are made anew from what is there."""
    _running.clear()
    Cache.close_all()


def _deforming(obj: bpy.types.Object) -> list[bpy.types.Modifier]:
    """Modifiers that move hair with the surface, which the simulation does itself."""
    found = []
    for modifier in obj.modifiers:
        if modifier.type == "NODES" and modifier.node_group is not None:
            if any(node.bl_idname == "GeometryNodeDeformCurvesOnSurface" for node in modifier.node_group.nodes):
                found.append(modifier)
    return found


def _switch_off(obj: bpy.types.Object) -> None:
    """Remembers which of them were on, in the blend file."""
    shown = [one for one in _deforming(obj) if one.show_viewport or one.show_render]
    for one in shown:
        obj[f"{SWITCHED}{one.name}"] = [one.show_viewport, one.show_render]
        one.show_viewport = one.show_render = False


def _switch_on(obj: bpy.types.Object) -> None:
    for key in [one for one in obj.keys() if one.startswith(SWITCHED)]:
        modifier = obj.modifiers.get(key.removeprefix(SWITCHED))
        if modifier is not None:
            modifier.show_viewport, modifier.show_render = map(bool, obj[key])
        del obj[key]


def start(scene: bpy.types.Scene, obj: bpy.types.Object, graph: bpy.types.Depsgraph) -> None:
    """The hair is simulated from here on, beginning at rest on this frame."""
    convert.checked(obj)
    if scene.frame_end <= scene.frame_start:
        raise Problem(f"The scene has the frames {scene.frame_start} to {scene.frame_end}: expected 2 or more")
    own = settings(obj)
    rest = obj.data.attributes.get(REST)
    if rest is None:
        points = convert.positions_of(obj.data)
        convert.write(obj.data.attributes.new(REST, "FLOAT_VECTOR", "POINT"), points)
    try:
        _running[obj.session_uid] = _make(scene, obj, graph)
    except Exception:
        if rest is None:
            obj.data.attributes.remove(obj.data.attributes[REST])
        raise
    _switch_off(obj)
    own.mode = "LIVE"
    own.status = ""


def stop(obj: bpy.types.Object) -> None:
    """Puts the hair back to rest."""
    _running.pop(obj.session_uid, None)
    rest = obj.data.attributes.get(REST)
    if rest is not None:
        convert.set_positions(obj.data, convert.read(rest))
        obj.data.attributes.remove(obj.data.attributes[REST])
    _switch_on(obj)
    settings(obj).mode = "OFF"
    obj.data.update_tag()


def stats(obj: bpy.types.Object) -> dict[str, Any] | None:
    live = _running.get(obj.session_uid)
    return live.simulation.stats() if live else None


def register() -> None:
    bpy.app.handlers.frame_change_post.append(on_frame)
    for handlers in (bpy.app.handlers.load_pre, bpy.app.handlers.undo_post, bpy.app.handlers.redo_post):
        handlers.append(forget)


def unregister() -> None:
    bpy.app.handlers.frame_change_post.remove(on_frame)
    for handlers in (bpy.app.handlers.load_pre, bpy.app.handlers.undo_post, bpy.app.handlers.redo_post):
        handlers.remove(forget)
    forget()
