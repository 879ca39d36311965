#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tries to harm: damaged files, kills, limits on file sizes, full disks, wrong command lines, ends of the window.

A fall is a crash, a hang, an error without words, a file that is neither the old nor the new one, or a success that is none. Everything
happens in a folder of the run; the seed repeats it. `./dev harm` builds first.
"""

import argparse
import hashlib
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

TIMEOUT_S = 60
WINDOW_S = 30  # a window that does not answer gets 25
FORMATS = {"hair": "hair", "tfx": "tfx", "abc": "abc", "usda": "usda", "usdc": "usdc", "obj-lines": "obj", "obj-c4d": "obj", "ply": "ply",
           "runtime": "hairrt"}


def png(width, height):
    """A grey ramp."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes((64 + x * 3 + y) & 255 for x in range(width)) for y in range(height))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def exr(width, height):
    """OpenEXR of three channels of floats, without compression."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data
    channels = b"".join(name + b"\0" + struct.pack("<IIII", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", channels) + attribute(b"compression", b"compression", b"\0") + \
        attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window) + \
        attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) + \
        attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)) + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    line = struct.pack(f"<{3 * width}f", *(0.5 for _ in range(3 * width)))
    begin = len(head) + 8 * height
    table = b"".join(struct.pack("<Q", begin + y * (8 + len(line))) for y in range(height))
    return head + table + b"".join(struct.pack("<iI", y, len(line)) + line for y in range(height))


def signals_as_usual():
    """Below nohup SIGHUP is ignored, and programs leave it so."""
    for one in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
        signal.signal(one, signal.SIG_DFL)


def is_old_or_new(found, old, new):
    """Of a folder, which is a list of names, some of the new ones may be there."""
    return found in (old, new) or (isinstance(found, list) and set(found) <= set(new))


class Harm:
    def __init__(self, bin_folder, root, folder, seed, deadline):
        self.cli = str(bin_folder / "hairloom-cli")
        self.window = str(bin_folder / "hairloom")
        self.root, self.folder, self.deadline = root, folder, deadline
        self.random = random.Random(seed)
        self.falls, self.counts = [], {}
        self.environment = dict(os.environ, XDG_DATA_HOME=str(folder / "data"), XDG_CONFIG_HOME=str(folder / "config"),
                                XDG_CACHE_HOME=str(folder / "cache"))

    def run(self, *arguments, **more):
        return subprocess.run([self.cli, *map(str, arguments)], cwd=self.folder, env=self.environment, capture_output=True, text=True,
                              errors="replace", timeout=TIMEOUT_S, **more)

    def must(self, *arguments):
        done = self.run(*arguments)
        if done.returncode != 0:
            sys.exit(f"harm: {' '.join(map(str, arguments))}: {done.stderr}")

    def count(self, part):
        self.counts[part] = self.counts.get(part, 0) + 1

    def fall(self, part, what, arguments):
        # Of a damaged file what did it is kept, to be looked at and to become a test.
        for damaged in self.folder.glob("damaged.*"):
            kept = Path("out/harm")
            kept.mkdir(parents=True, exist_ok=True)
            shutil.copy(damaged, kept / f"{len(self.falls)}-{damaged.name}")
        self.falls.append((part, what, " ".join(map(str, arguments))))
        print(f"FALL {part}: {what}: {' '.join(map(str, arguments))}", flush=True)

    def judge(self, part, arguments, codes=(0, 1), **more):
        """Runs a job and holds its end to what docs/cli.md promises; None where it fell."""
        self.count(part)
        try:
            done = self.run(*arguments, **more)
        except subprocess.TimeoutExpired:
            self.fall(part, f"did not end within {TIMEOUT_S} s", arguments)
            return None
        if done.returncode not in codes:
            self.fall(part, f"ended with {done.returncode}: {done.stderr.strip()[-200:]}", arguments)
            return None
        errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
        if done.returncode != 0 and len(errors) != 1:
            self.fall(part, f"{len(errors)} lines with error: {done.stderr.strip()[-200:]!r}", arguments)
            return None
        bare = ("std::bad_alloc", "[json.exception", "basic_string", "vector::")
        if errors and any(word in errors[0] for word in bare):
            self.fall(part, f"a library's words alone: {errors[0]}", arguments)
            return None
        return done

    # --- what is harmed

    def make_files(self):
        """One small file of each kind; the job that reads it."""
        head = self.root / "samples/bust/bust.glb"
        self.must("create", "--mesh", head, "--scalp", "material:scalp", "--count", 60, "--placement", "dart", "--length", 0.1, "--points", 8, "--seed", 3,
                  "-o", "g.hairloom")
        self.must("simulate", "g.hairloom", "--frames", 3, "--motion", "nod", "--record", "g.frames")
        script = '{"hairloom_script": 1, "operations": [{"op": "curl", "radius": 0.01, "frequency": 40}]}'
        (self.folder / "script.json").write_text(script)
        self.must("groom", "g.hairloom", "--script", "script.json", "-o", "s.hairloom")
        (self.folder / "stack.json").write_text(script.replace('"hairloom_script": 1, "operations"', '"operators"'))
        self.must("stack", "g.hairloom", "--from", "stack.json", "-o", "k.hairloom")
        (self.folder / "motion.json").write_text('{"keys": [{"t": 0}, {"t": 1, "translate": [0, 0.1, 0]}]}')
        shutil.copy(head, self.folder / "bust.glb")
        kinds = [("g.hairloom", ("info",)), ("g.hairloom", ("validate",)), ("bust.glb", ("validate",)),
                 ("g.frames", ("export", "g.hairloom", "--format", "abc", "--frames", "0,1", "--force", "-o", "f.abc", "--record")),
                 ("stack.json", ("stack", "g.hairloom", "-o", "s.hairloom", "--force", "--from")),
                 ("script.json", ("groom", "g.hairloom", "-o", "s.hairloom", "--force", "--script")),
                 ("motion.json", ("simulate", "g.hairloom", "--frames", "2", "--motion"))]
        for name, picture in (("mask.png", png(24, 16)), ("sky.exr", exr(16, 8))):
            (self.folder / name).write_bytes(picture)
        (self.folder / "settings.json").write_text('{"simulation": {"windSpeed": 2, "gravity": [0, -9.81, 0]}, "material": {"rootRadius": 5e-5}}')
        # Its picture is the damaged one, beside it.
        view = '{"camera": {"eye": [0, 1.6, 1], "target": [0, 1.6, 0], "fov_y_deg": 30}, "lights": [{"type": "environment", "image": "%s"}]}'
        (self.folder / "view.json").write_text(view % "sky.exr")
        (self.folder / "damaged_view.json").write_text(view % "damaged.exr")
        shutil.copy(self.root / "samples/bust/bust.obj", self.folder / "bust.obj")
        vertices = [line.split()[1:4] for line in (self.root / "samples/bust/bust.obj").read_text().splitlines() if line.startswith("v ")][:3]
        facet = "facet normal 0 0 1 outer loop " + " ".join("vertex " + " ".join(v) for v in vertices) + " endloop endfacet"
        (self.folder / "one.stl").write_text(f"solid one\n{facet}\nendsolid one\n")
        (self.folder / "one.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                                             "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                             + "\n".join(" ".join(v) for v in vertices) + "\n3 0 1 2\n")
        (self.folder / "spheres.json").write_text('[{"name": "skull", "centre": [0, 1.6, 0], "radius": 0.08}]')
        (self.folder / "look.json").write_text('{"rootColour": [0.1, 0.05, 0.02], "rootRadius": 4e-5}')
        tiny = ("--size", "16x16", "--passes", 1, "-o", "r.png", "--force")
        kinds += [("mask.png", ("create", "--mesh", "bust.glb", "--scalp", "material:scalp", "--count", 20, "-o", "i.hairloom", "--force", "--mask")),
                  ("mask.png", ("set", "g.hairloom", "-o", "s.hairloom", "--force", "--dye-image")),
                  ("settings.json", ("set", "g.hairloom", "-o", "s.hairloom", "--force", "--from")),
                  ("spheres.json", ("spheres", "g.hairloom", "-o", "s.hairloom", "--force", "--from")),
                  ("bust.obj", ("validate",)), ("one.stl", ("info",)), ("one.ply", ("info",)),
                  ("look.json", ("render", "g.hairloom", *tiny, "--material")),
                  ("view.json", ("render", "g.hairloom", *tiny, "--view")),
                  ("sky.exr", ("render", "g.hairloom", *tiny, "--view", "damaged_view.json"))]
        # The small files that fuzzing begins with, of formats that nothing here writes.
        for seed, job in (("strands_numpy/stored.npz", "import"), ("strands_numpy/deflated.npz", "import"), ("strands_numpy/strands.npy", "import"),
                          ("strands_mitsuba/two.txt", "import"), ("strands_mitsuba/two.hair", "import"), ("strands_counted/two.data", "import"),
                          ("strands_pbrt/two.pbrt", "import"), ("strands_tfxtext/two.tfx", "import"), ("fbx/triangle.fbx", "info"),
                          ("gltf/triangle.gltf", "info")):
            name = seed.replace("/", "-")
            shutil.copy(self.root / "tests/fuzz/corpus" / seed, self.folder / name)
            kinds.append((name, ("import", "-o", "i.hairloom", "--force") if job == "import" else (job,)))
        (self.folder / "jpeg_view.json").write_text(view % "damaged.jpg")
        shutil.copy(self.root / "tests/fuzz/corpus/jpeg/ramp.jpg", self.folder / "ramp.jpg")
        kinds.append(("ramp.jpg", ("render", "g.hairloom", *tiny, "--view", "jpeg_view.json")))
        for name, suffix in FORMATS.items():
            extra = ("--points", 8) if name == "tfx" else ()
            self.must("export", "g.hairloom", "--format", name, *extra, "--force", "-o", f"{name}.{suffix}")
            kinds.append((f"{name}.{suffix}", ("import", "-o", "i.hairloom", "--force")))
        return kinds

    def damage(self, data):
        data = bytearray(data)
        for _ in range(self.random.choice((1, 1, 2, 8, 64))):
            if not data:
                break
            at = self.random.randrange(len(data))
            way = self.random.randrange(6)
            if way == 0:
                data[at] ^= 1 << self.random.randrange(8)
            elif way == 1:
                del data[at:]
            elif way == 2:
                data[at:at + 4] = self.random.choice((b"\xff\xff\xff\xff", b"\0\0\0\0", b"\xff\xff\xff\x7f", b"\0\0\x80\x7f", b"\0\0\xc0\x7f"))
            elif way == 3:
                del data[at:at + self.random.randrange(1, 64)]
            elif way == 4:
                begin = self.random.randrange(len(data))
                data[at:at] = data[begin:begin + self.random.randrange(1, 256)]
            else:
                data[at:at] = self.random.choice((b"nan", b"-inf", b"1e39", b"-1", b"99999999999", b"\"", b"[", b"]", b"{", b"\n"))
        return bytes(data)

    def late(self):
        return time.monotonic() > self.deadline

    # --- the parts

    def damaged_files(self, kinds, number):
        for i in range(number):
            if self.late():
                break
            source, job = kinds[i % len(kinds)]
            path = self.folder / ("damaged" + Path(source).suffix)
            path.write_bytes(self.damage((self.folder / source).read_bytes()))
            for output in ("i.hairloom", "s.hairloom", "f.abc", "r.png"):
                (self.folder / output).unlink(missing_ok=True)
            words = job if job[-1].endswith("_view.json") else (*job, path.name)
            done = self.judge("damaged files", words)
            if done is None:
                continue
            for output in ("i.hairloom", "s.hairloom"):
                if done.returncode == 0 and path.suffix not in (".json", ".frames", ".glb") and output in job and not (self.folder / output).exists():
                    self.fall("damaged files", "succeeded and wrote nothing", words)
                if (self.folder / output).exists():
                    if done.returncode != 0:
                        self.fall("damaged files", "failed and left a file", words)
                    self.judge("damaged files", ("info", output), codes=(0,))

    def cut_strands(self, kinds, number):
        """Strands of which the end is missing are refused, or what is missing is told, or nothing is."""
        def read(name):
            (self.folder / "i.hairloom").unlink(missing_ok=True)
            words = ("import", "-o", "i.hairloom", "--force", name)
            done = self.judge("cut strands", words)
            if done is None or done.returncode != 0:
                return None
            return done.stderr, self.run("info", "i.hairloom", "--json").stdout
        sources = [source for source, job in kinds if job[0] == "import"]
        whole = {source: read(source) for source in sources}
        for i in range(number):
            if self.late():
                break
            source = sources[i % len(sources)]
            data = (self.folder / source).read_bytes()
            # Every second one lacks little.
            lost = self.random.randrange(1, min(64, len(data)) if i // len(sources) % 2 else len(data))
            # Text without counts can be cut between two lines unseen, which docs/security.md says.
            if source == "strands_mitsuba-two.txt" and data[:-lost].endswith(b"\n"):
                continue
            path = self.folder / ("damaged" + Path(source).suffix)
            path.write_bytes(data[:-lost])
            found = read(path.name)
            told, made = whole[source]
            if found is not None and found[1] != made and found[0].replace(path.name, source) == told:
                self.fall("cut strands", f"{source} without its last {lost} bytes came in as if whole", ("import", path.name))

    WRITERS = (  # a job, and what it writes
        (("set", "g.hairloom", "simulation.windSpeed=3", "-o", "k.hairloom"), ("k.hairloom",)),
        (("groom", "g.hairloom", "--script", "script.json", "-o", "k.hairloom"), ("k.hairloom",)),
        (("stack", "g.hairloom", "--from", "stack.json", "-o", "k.hairloom"), ("k.hairloom",)),
        (("import", "abc.abc", "-o", "k.hairloom"), ("k.hairloom",)),
        (("guides", "g.hairloom", "--count", 10, "-o", "k.hairloom"), ("k.hairloom",)),
        (("export", "g.hairloom", "--format", "usda", "-o", "k.usda"), ("k.usda", "k.usda.report.json")),
        (("export", "g.hairloom", "--format", "abc", "--record", "g.frames", "--frames", "0,2", "-o", "k.abc"), ("k.abc", "k.abc.report.json")),
        (("simulate", "g.hairloom", "--frames", "5", "--record", "k.frames"), ("k.frames",)),
        (("render", "g.hairloom", "--size", "64x64", "--passes", 1, "-o", "k.png"), ("k.png",)),
        (("lod", "g.hairloom", "--levels", "strands,shell:64", "--atlas", 64, "--directions", 1, "-o", "k"), ("k",)),
        (("stability", "g.hairloom", "--storms", "1", "-o", "k"), ("k",)),
    )

    def without(self, outputs):
        for output in outputs:
            path = self.folder / output
            shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)

    def kills(self, number):
        """Whatever the moment, what a job writes is the old or the new, and what is left is found."""
        known = []
        for job, outputs in self.WRITERS:
            job = (*job, "--force")
            self.without(outputs)
            begin = time.monotonic()
            self.must(*job)
            known.append((job, outputs, time.monotonic() - begin, [self.digest(output) for output in outputs]))
        for i in range(number):
            if self.late():
                break
            job, outputs, usual, after = known[i % len(known)]
            self.count("kills")
            self.without(outputs)
            before = [None] * len(outputs)
            # Every second time there is something to replace.
            if i // len(known) % 2 and not any("." not in output for output in outputs):
                for output in outputs:
                    (self.folder / output).write_bytes(b"old")
                before = [self.digest(output) for output in outputs]
            running = subprocess.Popen([self.cli, *map(str, job)], cwd=self.folder, env=self.environment, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL, preexec_fn=signals_as_usual)
            # Most of a job is its work: half of the kills come where it writes.
            time.sleep(self.random.uniform(0 if self.random.random() < 0.5 else 0.8 * usual, 1.2 * usual))
            sent = self.random.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP))
            running.send_signal(sent)
            running.wait()
            # Only what was whole stays.
            self.must("clean", "--remove")
            found = [self.digest(output) for output in outputs]
            wrong = [output for output, f, old, new in zip(outputs, found, before, after) if not is_old_or_new(f, old, new)]
            if wrong:
                self.fall("kills", f"{wrong} neither old nor new after signal {sent}", job)
            # No program can keep what follows a SIGKILL together; each file is whole all the same.
            elif sent != signal.SIGKILL and found not in (before, after):
                self.fall("kills", f"some of {outputs} are old and some new after signal {sent}", job)
            left = [str(file) for file in self.folder.rglob("*") if file.name.endswith(("hairloom-part", "hairloom-whole"))]
            if left:
                self.fall("kills", f"left {left}", job)
                for name in left:
                    Path(name).unlink()
            self.without(outputs)

    def digest(self, name):
        """Of a file, or of all below a folder without what measures time; None where there is nothing."""
        path = self.folder / name
        if path.is_dir():
            return sorted(str(file.relative_to(path)) for file in path.rglob("*"))
        return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else None

    def limits(self, number):
        """A limit on the size of files stops writing anywhere, as a quota does."""
        import resource
        for i in range(number):
            if self.late():
                break
            job, outputs = self.WRITERS[i % len(self.WRITERS)]
            self.without(outputs)
            bytes_ = int(10 ** self.random.uniform(1, 5.5))
            done = self.judge("limits of files", job, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, bytes_)))
            if done is None or done.returncode == 0:
                continue
            for output in outputs:
                if (self.folder / output).exists():
                    self.fall("limits of files", f"failed at {bytes_} bytes and left {output}", job)
        self.without(output for _, outputs in self.WRITERS for output in outputs)

    def disks(self, number):
        """A disk that is full at any byte: a file system in memory that only the job sees."""
        (self.folder / "disk").mkdir(exist_ok=True)
        try_ = ["unshare", "-rm", "mount", "-t", "tmpfs", "-o", "size=64k", "none", "disk"]
        if not shutil.which("unshare") or subprocess.run(try_, cwd=self.folder, capture_output=True, check=False).returncode != 0:
            print("full disks: skipped, nobody may mount here", flush=True)
            return
        script = 'mount -t tmpfs -o size=$0 none disk && { "$@"; code=$?; echo; find disk -mindepth 1 -printf "left %P\\n"; exit $code; }'
        for i in range(number):
            if self.late():
                break
            self.count("full disks")
            job, outputs = self.WRITERS[i % len(self.WRITERS)]
            words = (*job[:-1], f"disk/{job[-1]}")
            bytes_ = 4096 * int(10 ** self.random.uniform(0.3, 2.5))
            try:
                done = subprocess.run(["unshare", "-rm", "sh", "-c", script, str(bytes_), self.cli, *map(str, words)], cwd=self.folder,
                                      env=self.environment, capture_output=True, text=True, errors="replace", timeout=TIMEOUT_S, check=False)
            except subprocess.TimeoutExpired:
                self.fall("full disks", f"did not end within {TIMEOUT_S} s on {bytes_} bytes", words)
                continue
            left = [line[len("left "):] for line in done.stdout.splitlines() if line.startswith("left ")]
            if done.returncode not in (0, 1):
                self.fall("full disks", f"ended with {done.returncode} on {bytes_} bytes: {done.stderr[-200:]}", words)
            elif done.returncode == 1 and (left or done.stderr.count("error: ") != 1):
                self.fall("full disks", f"failed on {bytes_} bytes, left {left}: {done.stderr[-200:]}", words)
            elif done.returncode == 0 and any(output not in left for output in outputs):
                self.fall("full disks", f"succeeded on {bytes_} bytes with {left}", words)

    def command_lines(self, number):
        """Words that no job knows, numbers that are none, options without a value."""
        helps = self.run("--help").stdout
        jobs = [line.split()[0] for line in helps.splitlines() if line.startswith("  ") and line.split() and line.split()[0].islower()]
        jobs = [job for job in jobs if self.run(job, "--help").returncode == 0]
        options = {job: [word.split(",")[-1] for line in self.run(job, "--help").stdout.splitlines() for word in line.split()[:1]
                         if word.startswith("-")] for job in jobs}
        values = ("nan", "inf", "-1", "1e99", "", "x,y", "1,nan", "0x0", "99999999999999999999", "ÿ", "-", "--", "none.hairloom", "/dev/null", ".")
        for _ in range(number):
            if self.late():
                break
            job = self.random.choice(jobs)
            if job in ("bench", "stability", "accuracy", "reference", "peers"):
                continue  # these would measure for minutes where the words happen to be right
            arguments = [job]
            for _ in range(self.random.randrange(4)):
                arguments.append(self.random.choice(options[job] or ["--nothing"]))
                if self.random.random() < 0.8:
                    arguments.append(self.random.choice(values))
            if self.random.random() < 0.5:
                arguments.insert(1, self.random.choice(("g.hairloom", "none.hairloom", "stack.json", ".")))
            arguments = [word for word in arguments if word != "--force"]
            self.judge("command lines", arguments, codes=(0, 1, 2))

    def windows(self, number):
        """The window ends at any moment; the project it had open stays as it was."""
        if not os.environ.get("DISPLAY") or not os.path.exists(self.window):
            print("window ends: skipped, no display or no hairloom", flush=True)
            return
        shutil.copy(self.folder / "g.hairloom", self.folder / "w.hairloom")
        before = self.digest("w.hairloom")
        for _ in range(number):
            if self.late():
                break
            self.count("window ends")
            window = subprocess.Popen([self.window, "w.hairloom"], cwd=self.folder, env=dict(self.environment, HAIRLOOM_VIEWPORT="none"),
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                      preexec_fn=signals_as_usual)
            time.sleep(self.random.uniform(0.05, 8))
            sent = self.random.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGHUP))
            window.send_signal(sent)
            try:
                code = window.wait(timeout=WINDOW_S)
            except subprocess.TimeoutExpired:
                window.kill()
                self.fall("window ends", f"did not end after signal {sent}", ())
                continue
            if code != -sent:
                self.fall("window ends", f"ended with {code} after signal {sent}", ())
            if self.digest("w.hairloom") != before:
                self.fall("window ends", "the project has changed", ())
            copies = self.run("clean", "--json").stdout
            if '"copies": []' not in copies:
                self.fall("window ends", f"a copy of what was never changed: {copies}", ())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=Path, default=Path("build/release/bin"), help="folder of the programs")
    parser.add_argument("--files", type=int, default=2500)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--limits", type=int, default=80)
    parser.add_argument("--disks", type=int, default=80)
    parser.add_argument("--lines", type=int, default=500)
    parser.add_argument("--windows", type=int, default=20)
    parser.add_argument("--minutes", type=float, default=60, help="then each part ends, however far it is")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    root = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory(prefix="hairloom-harm-") as folder:
        harm = Harm(asked.bin.resolve(), root, Path(folder), asked.seed, time.monotonic() + 60 * asked.minutes)
        kinds = harm.make_files()
        harm.kills(asked.kills)
        harm.limits(asked.limits)
        harm.disks(asked.disks)
        harm.command_lines(asked.lines)
        harm.windows(asked.windows)
        harm.damaged_files(kinds, asked.files - asked.files // 5)
        harm.cut_strands(kinds, asked.files // 5)
    for part, count in harm.counts.items():
        fallen = sum(1 for fall in harm.falls if fall[0] == part)
        print(f"{part}: {count} runs, {fallen} falls")
    return 1 if harm.falls else 0


if __name__ == "__main__":
    sys.exit(main())
