# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases: what lies in the working directory, and how the program is called there."""

import re
import subprocess
from collections import namedtuple

import bases
import bodies
import formats
import mutations
import runs
import skins

# files: {name: bytes}; arguments: after the program's name; earlier: arguments of runs that come before and that must
# succeed; damage: {"file", "seed"} changes a file that these have left, or puts "by" in its place; plants: {name: text} of files put there then, a
# directory if None; check: what else must hold; place: the name of the working directory.
Case = namedtuple("Case", "kind files arguments earlier damage plants check place", defaults=([], None, {}, None, "run"))

OUT = ["--quiet", "--threads", "2", "--output", "out"]


def declared_keys(program):
    """({"Section/Key": what is allowed} of scenes, the same of studies), as the program prints them."""
    def read(*command):
        text = subprocess.run([program, *command, "--print-parameters"], capture_output=True, text=True, check=True).stdout
        keys, path, allowed = {}, [], ""
        for line in map(str.strip, text.splitlines()):
            if line.startswith("subsection "):
                path.append(line[11:])
            elif line == "end":
                path.pop()
            elif line.startswith("# Allowed: "):
                allowed = line[11:].split(". Default:")[0]
            elif match := re.match(r"set (.*?) =", line):
                keys["/".join([*path, match.group(1)])] = allowed
        return keys
    return read(), read("study")


def encode(text):
    return text.encode("utf-8", "surrogateescape")


def prm_bytes(entries):
    """A scene file of [("Section/Key", value)], a subsection for each."""
    lines = []
    for path, value in entries:
        *subsections, key = path.split("/")
        lines += [f"subsection {name}" for name in subsections]
        lines += [f"  set {key} = {value}"]
        lines += ["end"] * len(subsections)
    return encode("\n".join(lines) + "\n")


def good_files(entries):
    """The scene with the files that it may name."""
    return {"scene.prm": prm_bytes(entries), "mesh.msh": bases.msh_text(bases.box_mesh()),
            "pose.msh": bases.msh_text(bases.box_mesh(bases.bent)),
            "pose2.msh": bases.msh_text(bases.box_mesh(bases.stretched)), "held.txt": encode(bases.LIST)}


def scene_of(r, *with_files):
    scenes = [scene for scene in bases.SCENES if not with_files or "Mesh/File" in scene]
    return list(r.choice(scenes).items())


def key_in(r, keys, entries):
    """Any key that there is, of a handle or load that the scene has where it is of one."""
    path = r.choice([*keys, *(path for path, _ in entries)])
    names = [p.split("/")[1] for p, _ in entries if p.startswith(path.split("/")[0]) and p.count("/") == 2]
    if "/NAME/" in path:
        path = path.replace("NAME", r.choice(names or ["left"]))
    return path


def allowed_for(keys, path):
    section, *_, key = path.split("/") if "/" in path else ("", path)
    samples = [path, f"{section}/NAME/{key}", f"{section}/region 1/{key}"]
    return next((keys[sample] for sample in samples if sample in keys), "any text")


def spoil_scene(r, keys, entries):
    """Entries of a scene with one to four of them changed, added, doubled, misspelt or removed."""
    entries = list(entries)
    for _ in range(r.choice([1, 1, 1, 2, 3])):
        at = r.randrange(len(entries)) if entries else 0
        action = r.random()
        if action < 0.85 or not entries:
            path = key_in(r, keys, entries)
            entries = [entry for entry in entries if entry[0] != path]
            entries.insert(at, (path, mutations.value(r, path, allowed_for(keys, path))))
        elif action < 0.9:
            del entries[at]
        elif action < 0.92:
            entries.append(entries[at])
        elif action < 0.96:
            path, value = entries[at]
            i = r.randrange(len(path))
            entries[at] = path[:i] + r.choice(["", "x", "/", "\udcff", " ", "\0", "é"]) + path[i + 1:], value
        else:
            entries[at] = r.choice(["Mesh/", "Handles/left/", "Loads/x/", "Material/region 1/", "A/B/C/", ""]) + r.choice(
                list(keys)), entries[at][1]
    return entries


def scene_case(r, keys):
    entries = spoil_scene(r, keys[0], scene_of(r))
    files = good_files(entries)
    if r.random() < 0.15:
        files["scene.prm"] = mutations.spoilt_text(r, files["scene.prm"])
    return Case("scene", files, ["scene.prm", *OUT], check=r.choice([None, None, "again", "validate"]))


def extreme_case(r, keys):
    """Numbers of the right kind, and of any magnitude."""
    entries = dict(scene_of(r))
    numeric = [path for path, allowed in keys[0].items()
               if "number" in allowed and "/NAME/" not in path and path not in mutations.NUMBERS_OF]
    for path in r.sample(numeric, r.choice([1, 1, 2, 3])):
        n = 3 if "three" in keys[0][path] else 1
        entries[path] = ", ".join(mutations.magnitude(r, keys[0][path]) for _ in range(n))
    if r.random() < 0.3:
        path = r.choice(["Time/Step", "Time/End"])
        entries[path] = repr(r.choice(mutations.NUMBERS_OF[path]))
    return Case("extreme", good_files(entries.items()), ["scene.prm", *OUT], check=r.choice([None, None, "again"]))


def formula_case(r, _):
    entries = dict(scene_of(r))
    options = [path for path in entries if path.split("/")[-1] in mutations.FORMULA_KEYS]
    options += ["Handles/left/Motion"] if "Handles/Names" in entries else []
    options += ["Examples/Pose functions", "Initial/Pose function", "Initial/Velocity"]
    for path in r.sample(sorted(set(options)), r.choice([1, 1, 2])):
        entries[path] = mutations.formulas(r, path.split("/")[-1])
    return Case("formula", good_files(entries.items()), ["scene.prm", *OUT])


def mesh_case(r, _):
    files = good_files(scene_of(r, "Mesh/File"))
    files["mesh.msh"] = r.choice([bodies.spoilt_mesh, bodies.spoilt_body])(r, bases.box_mesh())
    return Case("mesh", files, ["scene.prm", *OUT])


def pose_case(r, _):
    files = good_files(scene_of(r, "Mesh/File"))
    name = r.choice(["mesh.msh", "pose.msh", "pose.msh", "pose2.msh"])
    mesh = bases.box_mesh(bases.place if name == "mesh.msh" else bases.bent)
    if r.random() < 0.6:
        mesh.nodes = bodies.odd_geometry(r, mesh.nodes)
        files[name] = bases.msh_text(mesh)
    else:
        files[name] = bodies.spoilt_mesh(r, mesh)
    return Case("pose", files, ["scene.prm", *OUT])


def list_case(r, _):
    entries = next(list(scene.items()) for scene in bases.SCENES if "nodes held.txt" in scene.values())
    files = good_files(entries)
    lines = [r.choice([str(1 + 3 * r.randrange(12)), str(r.choice(mutations.INTEGERS)), r.choice(mutations.TEXTS), "1 4", "1,4",
                       "# x", "1.0", "1e0", "1.000000000000000000e+00"]) for _ in range(r.choice([1, 3, 8]))]
    files["held.txt"] = r.choice([mutations.damaged(r, encode(bases.LIST)), encode("\n".join(lines))])
    return Case("list", files, ["scene.prm", *OUT])


AXES = ["Time/Increments: 1 2", "Time/Increments: 1 2", "Material/Density: 1e-300, 1e300",
        'Handles/left/Motion: "0; 0; t", "1/t; 0; 0"', "Solver/Method + Solver/Tolerance: newton + 1e-6, one pass + 1e-6",
        "Mesh/Scale: 1e78 1e-78 1 | Model/Strain: green linear"]
SETTINGS = ["Model/Gradient=consistent", "Output/Every=1; Loads/Gravity=0, 0, 1", "Loads/Gravity=0, 0, 1e300",
            "Material/Young's modulus=1e300", "", "Scene=static", "Material/Density=-1", "x", "a=b", ";", "=",
            "Handles/left/Motion=\"0; 0; t\""]
STUDY = ["study", "study.prm", "--quiet", "--output", "out"]


def study_value(r, path, allowed):
    odd = r.choice(mutations.TEXTS)
    numbers = ", ".join(mutations.number(r) for _ in range(r.choice([3, 3, 3, 2])))
    good = {"Vary": r.choice(AXES), "Base": r.choice(SETTINGS), "Reference": r.choice(SETTINGS), "Probe": numbers,
            "Columns": r.choice(["energy_kinetic", "step, step", "é", ",", "energy_elastic, time", "status", "no_such"]),
            "Scene": r.choice(["scene.prm", "study.prm", *mutations.FILES])}
    if path in good and r.random() < 0.2:
        at = r.randrange(len(good[path]) + 1)
        return good[path][:at] + odd + good[path][at:]
    return good[path] if path in good else mutations.value(r, path, allowed)


def study_case(r, keys):
    entries = bases.STUDY
    for path in r.sample(list(keys[1]), r.choice([1, 1, 2])):
        entries = {**entries, path: study_value(r, path, keys[1][path])}
    files = good_files(bases.SCENES[0].items())
    files["study.prm"] = prm_bytes(entries.items())
    if r.random() < 0.2:
        files["study.prm"] = mutations.spoilt_text(r, files["study.prm"])
    return Case("study", files, r.choice([STUDY, STUDY, STUDY, ["--validate", "study.prm"]]))


def checkpoint_case(r, _):
    """A run to half its time; then a damaged file, and --resume to the end."""
    scene = r.choice([scene for scene in bases.SCENES if scene["Scene"] == "dynamic"])
    files = good_files(scene.items())
    to_end = ["scene.prm", "--quiet", "--threads", "1"]
    half = [*to_end, "--set", "Time/End=0.02", "--output", "out"]
    file = r.choice(["checkpoint.bin"] * 9 + ["statistics.csv"])
    return Case("checkpoint", files, [*to_end, "--output", "out", "--resume"], [[*to_end, "--output", "whole"], half],
                {"file": "out/" + file, "seed": r.randrange(2**32)}, check="resumed")


GEO = ["SetFactory(\"OpenCASCADE\");", "Box(1) = {0, 0, 0, 2, 1, 1};", "Mesh.MeshSizeMin = 1;", "Mesh.MeshSizeMax = 1;"]
# what a mesh does not need, and nobody's scene may make the program do
HOSTILE = ['SystemCall "touch owned";', 'NonBlockingSystemCall "touch owned";', 'Printf("x") > "owned";', 'Save "owned.msh";',
           'Printf("x") >> "scene.prm";', 'CreateDirectory "owned";', 'Merge "mesh.msh";', 'Include "absent.geo";', "Abort;",
           'OnelabRun("touch", "owned");', "For i In {1:10000000}", "EndFor", "Box(2) = {0, 0, 0, 1e300, nan, -1};",
           "Mesh.Binary = 1;",
           'Error("exemplar: not ours");', "Mesh.SaveAll = 1;", "Delete All;", "Physical Volume(7) = {1};", "}", "\xff", "Exit;",
           'Plugin(NewView).Run; Save View[0] "owned";', 'General.LogFileName = "owned";']


def geo_case(r, _):
    entries = {**dict(bases.SCENES[6]), "Mesh/File": "body.geo", "Handles/left/Select": "box -1 -1 -1 0.1 2 2",
               "Handles/Names": "left", "Examples/Poses": ""}
    files = good_files((path, value) for path, value in entries.items() if "right end" not in path)
    lines = list(GEO)
    for _ in range(r.choice([1, 1, 2])):
        lines.insert(r.randrange(len(lines) + 1), r.choice(HOSTILE))
    files["body.geo"] = encode("\n".join(lines))
    return Case("geo", files, ["scene.prm", *OUT] if r.random() < 0.7 else ["--validate", "scene.prm"])


PRECIOUS = ["frame_0001.vtu/kept", "frame_0077.vtu", "notes.txt", "final.msh.tmp", "other.tmp", "study.csv", "running/kept",
            "runs/0123456789abcdef/kept.txt", "summary.json/kept", "checkpoint.bin", "animation.pvd", "statistics.csv", ".hidden"]
PLANTS = {**{name: "precious" for name in PRECIOUS}, "runs/0123456789abcdef/record.json": "{}", "checkpoint.bin.tmp": "",
          "frame_0001.vtu.tmp": "<?xml", "parameters.prm.tmp": "", "empty": None, "frame_0002.vtu": None}


def directory_case(r, _):
    """Something foreign lies in the directory of results, of an earlier run or of none."""
    files = good_files(bases.SCENES[r.choice([0, 1])].items())
    files["study.prm"] = prm_bytes(bases.STUDY.items())
    scene = ["scene.prm", *OUT]
    earlier = r.choice([[], [scene], [scene], [STUDY]])
    last = r.choice([scene, scene, [*scene, "--resume"], STUDY])
    names = r.sample(sorted(PLANTS), r.choice([1, 1, 2]))
    return Case("directory", files, last, earlier, None, {"out/" + name: PLANTS[name] for name in names})


def command_case(r, keys):
    files = good_files(scene_of(r))
    files["study.prm"] = prm_bytes(bases.STUDY.items())
    files["mesh.geo"] = b"SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n"
    path = r.choice(list(keys[0]))
    words = list(r.choice([["scene.prm", *OUT], ["scene.prm", *OUT], ["--validate", "scene.prm"], STUDY, ["verify", "--list"],
                           ["--print-parameters"], ["--help"], ["--version"], ["study", "--print-parameters"]]))
    pool = ["--set", "--output", "--resume", "--threads", "--quiet", "--verbose", "--validate", "--help", "--version", "--",
            "-h", "--set=", "--output=", "--threads=1", "-x", "--no-such", "verify", "study", "scene.prm", "study.prm", ".",
            "out", "é"]
    for _ in range(r.choice([1, 1, 2, 4])):
        at = r.randrange(len(words) + 1)
        action = r.randrange(5)
        if action == 0:
            words[at:at] = [r.choice(pool)]
        elif action == 1:
            del words[at:at + 1]
        elif action == 2:
            words[at:at] = ["--set", path + "=" + mutations.value(r, path, keys[0][path])]
        elif action == 3:
            words[at:at + 1] = [r.choice([text for text in mutations.TEXTS if "\0" not in text and len(text) < 10**5])]
        else:
            words[at:at] = ["--output", mutations.value(r, "Output/Directory", "any text")]
    if "verify" in words and "--list" not in words:  # all cases take a minute
        words.append("no such case")
    return Case("command", files, [word.replace("\0", "0") for word in words])


USE = {"Scene": "dynamic", "Mesh/File": "made.msh", "Time/Step": "0.01", "Time/End": "0.01"}


def surface_case(r, _):
    """A surface to be meshed."""
    ending, make = skins.form_of(r)
    data = skins.spoilt(r, skins.box_skin(), make)
    words = ["mesh", "--surface", "skin" + ending, "--cells", r.choice(skins.CELLS), "--output", "made.msh"]
    return Case("surface", {"skin" + ending: data, "use.prm": prm_bytes(USE.items())},
                words + r.choice([[], [], ["--repair"]]), check="meshed")


def posed_case(r, _):
    """A pose of a surface, or the surface at rest, or the mesh, is another one."""
    ending, make = skins.form_of(r)
    files = {"mesh.msh": bases.msh_text(bases.box_mesh()), "rest" + ending: make(skins.box_skin()),
             "posed" + ending: make(skins.box_skin(bases.bent))}
    bad = r.choice(["posed", "posed", "rest", "both", "mesh.msh"])
    for name, moved in (("posed", bases.bent), ("rest", bases.place)):
        if bad in (name, "both"):
            files[name + ending] = skins.spoilt(r, skins.box_skin(moved), make)
    if bad == "both" and r.random() < 0.5:
        files["posed" + ending] = files["rest" + ending]
    if bad == "mesh.msh":
        mesh = bases.box_mesh()
        mesh.nodes = bodies.odd_geometry(r, mesh.nodes)
        files[bad] = bases.msh_text(mesh)
    return Case("posed", files, ["pose", "--mesh", "mesh.msh", "--rest", "rest" + ending, "--pose", "posed" + ending,
                                 "--output", "out", "--attach", r.choice(["30", "30", "0.001", "1e6"])])


def skin_scene_case(r, _):
    """A scene that names surfaces."""
    ending, make = skins.form_of(r)
    rest, posed = "rest" + ending, "posed" + ending
    files = {rest: make(skins.box_skin()), posed: make(skins.box_skin(bases.bent)),
             "mesh.msh": bases.msh_text(bases.box_mesh())}
    for name, moved in r.choice([[(rest, bases.place)], [(posed, bases.bent)], [(posed, bases.bent)], []]):
        files[name] = skins.spoilt(r, skins.box_skin(moved), make)
    entries = {**bases.HELD, **bases.LATER, "Scene": "dynamic", "Mesh/File": rest, "Mesh/Cells": r.choice(skins.CELLS),
               "Handles/left/Select": "box -1 -1 -1 0.1 1 1", "Examples/Poses": posed, "Mesh/Repair": r.choice(["true", "false"]),
               "Mesh/Scale": r.choice(["1", "1", "0.001", "1e3"])}
    if r.random() < 0.3:
        entries = {**entries, "Mesh/File": "mesh.msh", "Mesh/Surface": rest, "Mesh/Scale": "1"}
    extra = r.choice([{}, {}, {}, {}, {}, {}, {"Initial/Pose": posed}, {"Handles/left/Follow pose": posed}, {"Examples/Attach": mutations.number(r)},
                      {"Mesh/Generator": "box"}, {"Mesh/Surface": posed}, {"Mesh/Surface": "absent.obj"}])
    return Case("skin_scene", {**files, "scene.prm": prm_bytes({**entries, **extra}.items())}, ["scene.prm", *OUT],
                check=r.choice([None, "again", "validate"]))


SHELL = {"Mesh/Kind": "shell", "Material/Thickness": "0.05", "Examples/Importance": "0.7"}


def shell_case(r, keys):
    """A shell of a surface, or of a run's result, with any keys, numbers, formulas or a spoilt file."""
    ending, make = skins.form_of(r)
    rest, posed = "rest" + ending, "posed" + ending
    files = {rest: make(skins.box_skin()), posed: make(skins.box_skin(bases.bent))}
    entries = {**SHELL, "Mesh/File": rest, **r.choice([{**bases.LATER, "Scene": "dynamic"}, {"Scene": "static", "Time/Increments": "2"}]),
               **bases.HELD, "Handles/left/Select": "box -1 -1 -1 0.1 1 1", "Loads/Gravity": "0, 0, -1"}
    entries.update(r.choice([{}, {"Examples/Poses": posed}, {"Examples/Pose functions": bases.BENT}]))
    entries.update(r.choice([{}, {"Model/Shell": "hinges"}, {"Handles/left/Slopes": "free"}]))
    if r.random() < 0.4:
        entries["Material/Volume stiffness"] = r.choice(["1e5", "1e5", mutations.magnitude(r, "a number >= 0")])
    what = r.randrange(4)
    if what == 0:
        name, moved = r.choice([(rest, bases.place), (posed, bases.bent)])
        files[name] = skins.spoilt(r, skins.box_skin(moved), make)
    elif what == 1:
        entries = dict(entry for entry in spoil_scene(r, keys[0], entries.items()))
    elif what == 2:
        numeric = [path for path, allowed in keys[0].items() if "number" in allowed and "/NAME/" not in path and path not in mutations.NUMBERS_OF]
        for path in ["Material/Thickness"] * r.randrange(2) + r.sample(numeric, 1):
            n = 3 if "three" in keys[0][path] else 1
            entries[path] = ", ".join(mutations.magnitude(r, keys[0][path]) for _ in range(n))
    else:
        path = r.choice(["Examples/Pose functions", "Initial/Pose function", "Initial/Velocity", "Handles/left/Motion"])
        entries[path] = mutations.formulas(r, path.split("/")[-1])
    return Case("shell", {**files, "scene.prm": prm_bytes(entries.items())}, ["scene.prm", *OUT], check=r.choice([None, None, "again", "validate"]))


MAPS = ["Material/Young's modulus map", "Material/Poisson's ratio map", "Material/Density map", "Examples/Weight maps"]


def painted_case(r, _):
    """Maps painted on the surface of a mesh, and handles that follow a point cache of it."""
    skin = skins.box_skin()
    entries = {**bases.FILE, **bases.HELD, **bases.LATER, "Scene": "dynamic", "Mesh/Surface": "rest.obj", "Examples/Poses": "pose.msh"}
    files = good_files([])
    files["rest.obj"] = skins.obj(skin)
    values = skins.odd_values(r, len(skin.vertices))
    name, content = r.choice([("paint.csv", skins.table(values)), ("paint.csv", skins.table(values, "two")),
                              ("paint.ply", skins.painted_ply(skin, values))])
    files[name] = r.choice([content, mutations.damaged(r, content), mutations.spoilt_text(r, content)])
    column = r.choice(["", "", ":paint", ":paint", ":" + r.choice(mutations.TEXTS)[:50]]) if name == "paint.csv" else ":paint"
    words = name + column + r.choice(["", "", " absolute", " from 0 to 2", f" from {mutations.number(r)} to {mutations.number(r)}"])
    action = r.randrange(4)
    if action == 0:
        entries["Handles/left/Select"] = f"map {name}{column}" + r.choice(["", f" above {mutations.number(r)}", " below 0.5"])
    elif action == 1:
        ending, make = r.choice([(".mdd", skins.mdd), (".pc2", skins.pc2)])
        files["rig" + ending] = skins.odd_cache(r, skin, make)
        entries["Handles/left/Follow cache"] = "rig" + ending
        entries["Handles/left/Cache start"] = r.choice(["file", "file", "0", mutations.number(r)])
    else:
        path = r.choice(MAPS)
        entries[path] = name + column if path.startswith("Examples") else words
    return Case("painted", {**files, "scene.prm": prm_bytes(entries.items())}, ["scene.prm", *OUT],
                check=r.choice([None, None, "again", "validate"]))


def state_case(r, _):
    """A run with kept states, of which one is damaged, or in place of another; then --resume-from."""
    scene = {**r.choice([scene for scene in bases.SCENES if scene["Scene"] == "dynamic"]), "Output/Keep states": "true",
             "Output/Every": "1"}
    words = ["scene.prm", "--quiet", "--threads", "1"]
    step = r.randrange(5)
    file = r.choice([f"state_000{step}.bin"] * 3 + ["checkpoint.bin", "statistics.csv"])
    other = f"state_000{r.choice([k for k in range(5) if k != step])}.bin"
    return Case("state", good_files(scene.items()), [*words, "--output", "out", "--resume-from", str(step)],
                [[*words, "--output", "whole"], [*words, "--output", "out"]],
                {"file": "out/" + file, "seed": r.randrange(2**32), "by": "out/" + other if r.random() < .3 else None},
                check="resumed")


def session_case(r, _):
    """A recorded session is played that no hand has made so."""
    entries = {**bases.SCENES[0], "Scene": "dynamic", "Time/Increments": "", "Time/Step": "0.01", "Time/End": "0.05", "Session/File": "session.txt"}
    files = good_files((path, value) for path, value in entries.items() if path != "Time/Increments")
    return Case("session", {**files, "session.txt": runs.session(r)}, ["scene.prm", *OUT], check=r.choice([None, "validate"]))


def export_case(r, _):
    """A run of which one file is damaged is shown as a page, or as glTF."""
    scene = {**r.choice([scene for scene in bases.SCENES if scene["Scene"] == "dynamic"]), "Output/Every": "1"}
    files = good_files(scene.items())
    of_page = ["frame_0000.vtu"] * 5 + ["frame_0001.vtu"] * 2 + ["animation.pvd"] * 2 + ["statistics.csv", "summary.json"]
    of_gltf = [*of_page, "parameters.prm", "checkpoint.bin", "final.msh"]
    arguments = r.choice([["--html", "page.html"], ["--gltf", "page.glb", *r.choice([[], ["--normals"], ["--shapes", "3"]])]])
    if "--gltf" in arguments and r.random() < 0.6:  # of a surface
        scene = {**bases.FILE, **bases.HELD, **bases.LATER, "Scene": "dynamic", "Mesh/Surface": "rest.obj", "Examples/Poses": "pose.msh",
                 "Output/Formats": r.choice(["pc2", "mdd"]), "Output/Every": "1"}
        files = {**good_files(scene.items()), "rest.obj": skins.obj(skins.box_skin())}
        of_gltf = ["animation." + scene["Output/Formats"], "rest.obj", "weight_1.obj", "statistics.csv", "parameters.prm", "summary.json"]
    file = r.choice(of_page if "--html" in arguments else of_gltf)
    return Case("export", files, ["export", "out", *arguments], [["scene.prm", *OUT]],
                {"file": "out/" + file, "seed": r.randrange(2**32), "how": "spoilt_frame" if file.endswith("vtu") else "damaged"})


def format_case(r, _):
    """A spoilt mesh of another program; a body that stays where it is, so that the result has what was read."""
    files, name = formats.spoilt(r)
    entries = {"Scene": "dynamic", "Mesh/File": name, "Time/Step": "0.01", "Time/End": "0.01", "Output/Every": "0"}
    return Case("format", {**files, "scene.prm": prm_bytes(entries.items())}, ["scene.prm", *OUT], check="second_reader")


KINDS = [(shell_case, 8), (format_case, 8), (session_case, 6), (export_case, 6), (painted_case, 4), (state_case, 4), (surface_case, 2), (posed_case, 3), (skin_scene_case, 2), (scene_case, 20), (extreme_case, 16), (formula_case, 12), (mesh_case, 16), (pose_case, 8), (list_case, 3),
         (study_case, 5), (checkpoint_case, 8), (command_case, 7), (geo_case, 1), (directory_case, 3)]
PLACES = ["a b", "é", "a#b", "a,b", "a;b", 'a"b', "a\nb", "\udcff", "%s", "a\\", "-", "n" * 200, "$HOME", "a=b", "a'b", "a|b",
          "\x1b[1m"]


def make_case(r, keys, kind=None):
    makers = [maker for maker, _ in KINDS if kind is None or maker.__name__ == kind + "_case"]
    weights = [weight for maker, weight in KINDS if maker in makers]
    case = r.choices(makers, weights)[0](r, keys)
    return case._replace(place=r.choice(PLACES)) if r.random() < 0.04 else case
