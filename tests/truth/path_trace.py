# SPDX-License-Identifier: GPL-3.0-or-later
"""The same head, strands, camera and lights as a view file of hairloom-cli, path-traced by Mitsuba 3 with the hair
model of Chiang et al. 2016."""

from pathlib import Path

import numpy as np

from hair_file import Strands

# Mitsuba's B-spline curves crash on a hit at the very end of a shape's last segment, and slow down in large shapes.
_SEGMENTS_PER_SHAPE = 16000
_UNREACHABLE = 1e4


def start() -> "module":
    """Mitsuba, vectorised where LLVM is there."""
    import mitsuba

    for variant in ("llvm_ad_rgb", "scalar_rgb"):
        try:
            mitsuba.set_variant(variant)
            mitsuba.Float(1) + 1
            return mitsuba
        except (ImportError, RuntimeError):
            continue
    raise SystemExit("error: Mitsuba does not start")


def spline_controls(points: np.ndarray) -> np.ndarray:
    """Control points of the uniform cubic B-spline that passes through `points`, doubled at both ends so that it
    starts at the first and ends at the last."""
    n = len(points)
    matrix = np.zeros((n + 2, n + 2))
    right = np.zeros((n + 2, 3))
    for i in range(n):
        matrix[i + 1, i : i + 3] = (1, 4, 1)
        right[i + 1] = 6 * points[i]
    # No curvature at the ends.
    matrix[0, 0:3] = (1, -2, 1)
    matrix[-1, -3:] = (1, -2, 1)
    return np.linalg.solve(matrix, right)


def write_curves(strands: Strands, root_radius: float, tip_scale: float, folder: Path) -> list[Path]:
    """Mitsuba's text files of curves, one shape each."""
    folder.mkdir(parents=True, exist_ok=True)
    files, lines, segments = [], [], 0

    def flush() -> None:
        nonlocal lines, segments
        if not lines:
            return
        lines += ["", *(f"{_UNREACHABLE + i} {_UNREACHABLE} {_UNREACHABLE} 1e-6" for i in range(4))]
        path = folder / f"curves_{len(files):03}.txt"
        path.write_text("\n".join(lines) + "\n")
        files.append(path)
        lines, segments = [], 0

    for i in range(len(strands)):
        controls = spline_controls(strands[i])
        length = np.linalg.norm(np.diff(controls, axis=0), axis=1)
        along = np.concatenate([[0], np.cumsum(length)])
        # The profile of hairloom-cli.
        radius = root_radius * (1 + (tip_scale - 1) * (along / max(along[-1], 1e-12)) ** 2)
        if segments + len(controls) > _SEGMENTS_PER_SHAPE:
            flush()
        lines.append("")
        lines += [f"{x:.7g} {y:.7g} {z:.7g} {r:.6g}" for (x, y, z), r in zip(controls, radius)]
        segments += len(controls)
    flush()
    return files


class TruthScene:
    """`view` is the content of a view file; lights may be directional, rectangles, or an environment of one radiance.
    `pixel_filter`: of Mitsuba; a box where nothing is given."""

    def __init__(self, mi, view: dict, eumelanin: float, head: Path, curves: list[Path], pixel_filter: dict | None = None):
        self.mi = mi
        self.size = view["size"]
        hair = view["hair"]
        bsdf = {
            "type": "hair",
            "eumelanin": eumelanin,
            "pheomelanin": 0.0,
            "int_ior": hair["ior"],
            "ext_ior": 1.0,
            "longitudinal_roughness": 0.3,
            "azimuthal_roughness": hair["azimuthal_roughness"],
            # Positive tilts move R towards the tip of curves that begin at the root.
            "scale_tilt": hair["alpha_deg"][0],
        }
        camera = view["camera"]
        to_world = mi.ScalarTransform4f().look_at(camera["eye"], camera["target"], camera["up"])
        scene = {
            "type": "scene",
            "sensor": {
                "type": "perspective",
                "fov": camera["fov_y_deg"],
                "fov_axis": "y",
                "to_world": to_world,
                "film": {
                    "type": "hdrfilm",
                    "width": self.size[0],
                    "height": self.size[1],
                    "rfilter": pixel_filter or {"type": "box"},
                    "pixel_format": "rgb",
                },
            },
            "head": {
                "type": head.suffix[1:].lower(),
                "filename": str(head),
                "bsdf": {
                    "type": "twosided",
                    "bsdf": {
                        "type": "diffuse",
                        "reflectance": {"type": "rgb", "value": view["head_albedo"]},
                    },
                },
            },
            "hair_bsdf": bsdf,
        }
        for i, light in enumerate(view["lights"]):
            scene[f"light_{i}"] = self._light(mi, light)
        for i, path in enumerate(curves):
            scene[f"curves_{i}"] = {
                "type": "bsplinecurve",
                "filename": str(path),
                "hair": {"type": "ref", "id": "hair_bsdf"},
            }
        self.scene = mi.load_dict(scene)

    @staticmethod
    def _light(mi, light: dict) -> dict:
        if light["type"] == "directional":
            return {
                "type": "directional",
                "direction": [-v for v in light["to_light"]],
                "irradiance": {"type": "rgb", "value": light["irradiance"]},
            }
        if light["type"] == "environment" and "radiance" in light:
            return {"type": "constant", "radiance": {"type": "rgb", "value": light["radiance"]}}
        if light["type"] == "rectangle":
            position, facing = np.array(light["position"]), np.array(light["facing"])
            placed = mi.ScalarTransform4f().look_at(position, position + facing, light.get("up", [0, 1, 0]))
            size = mi.ScalarTransform4f().scale([light["width"] / 2, light["height"] / 2, 1])
            radiance = {"type": "rgb", "value": light["radiance"]}
            return {"type": "rectangle", "to_world": placed @ size, "emitter": {"type": "area", "radiance": radiance}}
        raise SystemExit(f"error: a light of type {light['type']!r} has no counterpart here")

    def render(self, depth: int, samples: int, first_seed: int = 0) -> np.ndarray:
        """Linear RGB, height × width × 3. Depth 2 is single scattering with opaque shadows. Other seeds give other noise."""
        integrator = self.mi.load_dict(
            {"type": "path", "max_depth": depth, "rr_depth": 1000, "hide_emitters": True}
        )
        image, step = 0.0, 16
        rounds = max(1, samples // step)
        for seed in range(first_seed, first_seed + rounds):
            image = image + np.array(
                self.mi.render(self.scene, integrator=integrator, spp=step, seed=seed)
            )
        return image / rounds

    def coverage(self, per_side: int = 4) -> np.ndarray:
        """Share of each pixel that shows hair, by a grid of rays; height × width."""
        mi = self.mi
        width, height = self.size
        head_name = "head"
        sensor = self.scene.sensors()[0]
        total = np.zeros((height, width))
        for sub in range(per_side * per_side):
            x = (np.arange(width) + (sub % per_side + 0.5) / per_side) / width
            y = (np.arange(height) + (sub // per_side + 0.5) / per_side) / height
            grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
            total += self._hits_hair(mi, sensor, grid, head_name).reshape(height, width)
        return total / (per_side * per_side)

    def _hits_hair(self, mi, sensor, positions: np.ndarray, head_name: str) -> np.ndarray:
        if mi.variant().startswith("scalar"):
            return np.array([self._hit_name(mi, sensor, p) not in ("", head_name) for p in positions])
        film = mi.Point2f(positions[:, 0], positions[:, 1])
        ray, _ = sensor.sample_ray(0.0, 0.5, film, mi.Point2f(0.5))
        hit = self.scene.ray_intersect_preliminary(ray)
        head = next(s for s in self.scene.shapes() if s.id() == head_name)
        return np.array(hit.is_valid() & (hit.shape != mi.ShapePtr(head)))

    def _hit_name(self, mi, sensor, position: np.ndarray) -> str:
        ray, _ = sensor.sample_ray(0.0, 0.5, mi.Point2f(*position), mi.Point2f(0.5))
        hit = self.scene.ray_intersect_preliminary(ray)
        return hit.shape.id() if hit.is_valid() else ""
