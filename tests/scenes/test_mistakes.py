# SPDX-License-Identifier: GPL-3.0-or-later
"""Mistakes that people make, and the remedy that the message must hold; nothing is written."""

import csv
import subprocess
import unittest

from bad_inputs import DYNAMIC, FILE, BadInputTest
from exemplar_runner import BAR, EXEMPLAR, SceneTest, prm
from surfaces import cube, joined, write_obj


FREE = {**BAR, "Examples/Pose functions": "1.1*x; y; z"}
TWO = {**BAR, "Handles/Names": "left, right", "Handles/right/Select": "boundary 2", "Handles/right/Motion": "0; 0; t"}
LOADED = {**BAR, "Loads/Names": "tip", "Loads/tip/Select": "boundary 2", "Loads/tip/Force": "0; 0; -1"}
INDENTED = """set Scene = static
subsection Mesh
  set Generator = box
  set Box size = 2, 1, 1
  set Box cells = 2, 1, 1
end
subsection Examples
  set Pose functions = 1.1*x; y; z
end
subsection Handles
  set Names = left
  subsection left
    set Select = boundary 1
  end
end
"""


def without_line(number):
    lines = INDENTED.splitlines()
    return "\n".join(lines[:number - 1] + lines[number:]) + "\n"


def left(**keys):
    return {**BAR, **{f"Handles/left/{key}": value for key, value in keys.items()}}


# name: (scene, words of the message)
SCENES = {
    # values
    "decimal comma": ({**FREE, "Examples/Importance": "0,3"}, ["decimal sign is a point", "Did you mean '0.3'"]),
    "decimal commas in a list": ({**BAR, "Mesh/Box size": "2,5, 1,0, 1,0"}, ["decimal sign is a point", "'2.5, 1.0, 1.0'"]),
    "list by blanks": ({**BAR, "Loads/Gravity": "0 0 -9.81"}, ["by commas", "'0, 0, -9.81'"]),
    "list in brackets": ({**BAR, "Loads/Gravity": "[0, 0, -9.81]"}, ["brackets", "'0, 0, -9.81'"]),
    "Greek pi": (left(Motion="0; 0; π*t"), ["The constant is written pi"]),
    "more cells than memory": ({**BAR, "Mesh/Box cells": "800, 400, 400"}, ["million tetrahedra", "GiB", "Give smaller counts"]),
    "one number for three": ({**BAR, "Loads/Gravity": "-9.81"}, ["three numbers", "It is a vector. Did you mean '0, 0, -9.81'?"]),
    "cells by x": ({**BAR, "Mesh/Box cells": "16x4x4"}, ["by commas", "'16, 4, 4'"]),
    "unit behind a number": ({**BAR, "Material/Young's modulus": "210 GPa"}, ["alone, in Pa", "Did you mean '2.1e11'"]),
    "milliseconds": ({**DYNAMIC, "Time/Step": "10 ms"}, ["alone, in s", "Did you mean '0.01'"]),
    "fraction": ({**DYNAMIC, "Time/Step": "1/25"}, ["No formula", "'0.04'"]),
    "fraction of many digits": ({**DYNAMIC, "Time/Step": "1/24"}, ["No formula", "'0.0416666666667'"]),
    "unit of a list": ({**BAR, "Mesh/Box size": "400 mm, 100 mm, 10 cm"}, ["alone, in m", "'0.4, 0.1, 0.1'"]),
    "unit that is unknown": ({**BAR, "Material/Young's modulus": "1 furlong"}, ["without its unit", "E [Pa]"]),
    "below the least number": ({**BAR, "Solver/Tolerance": "1e-20"}, ["1e-16 ... 1", "has converged"]),
    "sentence with e.g.": ({**BAR, "Mesh/Scale": "word"}, ["e.g. 0.001 for millimetres."]),
    "numbers for a choice": ({**FREE, "Examples/Weights": "0.3; 0.7"}, ["simplex, free, prescribed", "not a number", "as Prescribed weights gives them"]),
    "weights one short": ({**FREE, "Examples/Pose functions": "1.1*x; y; z | 1.2*x; y; z", "Examples/Weights": "prescribed",
                           "Examples/Prescribed weights": "1-t; t"}, ["2 weights for 3 examples", "example 2 (pose function '1.2*x; y; z') lacks one"]),
    "negative step": ({**DYNAMIC, "Time/Step": "-0.01"}, ["cannot be negative", "'0.01'"]),
    "negative density": ({**BAR, "Material/Density": "-1000"}, ["cannot be negative", "'1000'"]),
    "digits in groups": ({**BAR, "Material/Density": "1,000"}, ["not grouped", "Did you mean '1000'?"]),
    "power of Fortran": ({**BAR, "Material/Density": "1D3"}, ["have an e", "'1e3'"]),
    "comment behind a semicolon": ({**BAR, "Material/Density": "1000 ; kg"}, ["comment begins with #", "'1000'"]),
    "formula for a number": ({**BAR, "Material/Density": "10^3"}, ["No formula", "'1000'"]),
    "longer name of a choice": ({**BAR, "Solver/Method": "Newton-Raphson"}, ["Did you mean 'newton'?"]),
    "formula of places for a number": ({**BAR, "Material/Density": "1e3*(1+x)"}, ["'1e3*(1+x)' is not allowed", "Default: '1000'. Its meaning"]),
    "percent": ({**FREE, "Examples/Importance": "50%"}, ["share of 1", "'0.5'"]),
    "Poisson's ratio in percent": ({**BAR, "Material/Poisson's ratio": "49"}, ["share of 1", "'0.49'"]),
    "integer as a power": ({**BAR, "Time/Increments": "1e2"}, ["all digits", "'100'"]),
    "semicolon behind a value": ({**BAR, "Material/Density": "1000;"}, ["No sign ends a line", "'1000'"]),
    "comment of C++ behind a value": ({**BAR, "Material/Density": "1000 // kg"}, ["comment begins with #", "'1000'"]),
    "capital": ({**BAR, "Scene": "Static"}, ["Did you mean 'static'"]),
    "quotes": ({**BAR, "Scene": '"static"'}, ["no quotes", "'static'"]),
    "yes for true": ({**FREE, "Examples/Include rest pose": "yes"}, ["Did you mean 'true'"]),
    "formats by blanks": ({**BAR, "Output/Formats": "vtu ply"}, ["by commas", "'vtu, ply'"]),
    "format misspelt": ({**BAR, "Output/Formats": "vtk"}, ["Did you mean 'vtu'"]),
    # keys
    "symbol for a key": ({**BAR, "Material/nu": ".3"}, ["Did you mean 'Material/Poisson's ratio'"]),
    "other apostrophe": ({**BAR, "Material/Young’s modulus": "1e6"}, ["Did you mean 'Material/Young's modulus'"]),
    "key of another section": ({**DYNAMIC, "Solver/Step": ".1"}, ["Did you mean 'Time/Step'"]),
    "old key": ({**BAR, "Output/Format": "vtu"}, ["Did you mean 'Output/Formats'"]),
    "key of another section by name": ({**BAR, "Handles/left/Velocity": "0; 0; 1"}, ["A handle is moved by Motion", "'Initial/Velocity'", "Section Handles/left has the keys Select"]),
    "key of no section": ({**DYNAMIC, "Time/Start": "0"}, ["Section Time has the keys Scheme, Step"]),
    "key that is in named sections": ({**BAR, "Loads/Force": "0; 0; 1"}, ["has keys of its own, in a subsection each", "Loads/NAME/Force"]),
    "key of a handle in a load": ({**LOADED, "Loads/tip/Motion": "0; 0; t"}, ["no parameter 'Loads/tip/Motion'. Section Loads/tip has the keys Select, Force"]),
    "key that is far from all": ({**LOADED, "Loads/tip/Pressure": "5"}, ["Loads/tip has the keys Select, Force"]),
    "handle outside of Handles": ({**BAR, "left/Motion": "0; 0; t"}, ["Did you mean 'Handles/left/Motion'"]),
    "section misspelt": ({**BAR, "Handle/left/Motion": "0; 0; t"}, ["Did you mean 'Handles/left/Motion'"]),
    # names
    "names by blanks": ({**TWO, "Handles/Names": "left right"}, ["by commas: set Names = left, right."]),
    "names of loads by blanks": ({**LOADED, "Loads/Names": "tip top"}, ["by commas: set Names = tip, top."]),
    "names by semicolons": ({**TWO, "Handles/Names": "left; right"}, ["Names are separated by commas"]),
    "names in quotes": ({**TWO, "Handles/Names": '"left", "right"'}, ["without quotes"]),
    "name with a capital": ({**TWO, "Handles/Names": "Left, right"}, ["Did you mean Handles/Left?"]),
    "Names misspelt": ({**LOADED, "Loads/Names": None, "Loads/Name": "tip"}, ["'Loads/Name'. Did you mean 'Loads/Names'?"]),
    # lines
    "inner end is missing": (without_line(14), ["scene.prm:12: subsection 'left' is not closed before line 14"]),
    "end of Mesh is missing": (without_line(6), ["scene.prm:2: subsection 'Mesh' is not closed before line 6", "'Examples' begins"]),
    "end of Examples is missing": (without_line(9), ["scene.prm:7: subsection 'Examples' is not closed before line 9"]),
    "last end is missing": (without_line(15), ["scene.prm:10: subsection 'Handles' is not closed before the file ends"]),
    "end is missing without indentation": (prm(TWO).replace("end\nend\nsubsection Loads", "end\nsubsection Loads"),
                                           ["'Handles' is not closed before line", "'Loads' begins"]),
    "no set": (prm(BAR) + "Density = 1000\n", ["Did you mean 'set Density = 1000'"]),
    "YAML": (prm(BAR) + "Density: 1000\n", ["Did you mean 'set Density = 1000'"]),
    "set with a colon": (prm(BAR) + "set Density: 1000\n", ["':' does not stand for '='"]),
    "comment of C++": (prm(BAR) + "// bar\n", ["comment begins with #"]),
    "section in brackets": ("[Mesh]\n", ["Did you mean 'subsection Mesh'"]),
    "subsection with a path": ("subsection Handles/left\n", ["'subsection Handles' and within it 'subsection left'"]),
    "braces": ("Mesh {\n}\n", ["Did you mean 'subsection Mesh', closed by a line 'end'?"]),
    "two keys in a line": ("set Scene = static; set Mesh/Generator = box\n", ["A line sets one key", "'static'"]),
    "section": ("section Mesh\n", ["Did you mean 'subsection Mesh'"]),
    "end with a name": ("subsection Mesh\nend subsection\n", ["Write 'end' alone"]),
    "END": ("subsection Mesh\nEND\n", ["small letters"]),
    "include": ("include other.prm\n", ["--set"]),
    "value over two lines": ("set Scene = static\n0; 0;\n", ["backslash"]),
    "empty": ("\n", ["scene.prm: Scene is not set, as the file is empty. Add a line"]),
    "script of Python": ("import exemplar\n", ["a script of Python, not like a scene: run it by python3"]),
    "packed": (b"PK\x03\x04\x14\x00", ["is a packed file", "Unpack it"]),
    "UTF-16": (prm(BAR).encode("utf-16"), ["saved as UTF-16", "UTF-8"]),
    # formulas
    "semicolon at the end": (left(Motion="0; 0; t;"), ["4 formulas", "Remove the ';' at the end"]),
    "decimal commas": (left(Motion="0,5, 0, t"), ["1 formula,", "decimal sign is a point"]),
    "one formula": (left(Motion="t"), ["for x, y and z"]),
    "decimal comma in a formula": (left(Motion="0,5*t; 0; 0"), ["'0,5*t' holds a comma", "decimal sign is a point"]),
    "power of Python": (left(Motion="t**2; 0; 0"), ["written x^2"]),
    "numpy": (left(Motion="np.sin(t); 0; 0"), ["no prefix"]),
    "product without a sign": (left(Motion="2t; 0; 0"), ["written 2*t"]),
    "degrees": (left(Motion="sin(90 deg*t); 0; 0"), ["in radians", "90*pi/180"]),
    "step function": (left(Motion="heaviside(t-.5); 0; 0"), ["t > 0.5 ? 1 : 0"]),
    "capital T": (left(Motion="T; 0; 0"), ["time is t"]),
    "Pi": (left(Motion="Pi*t; 0; 0"), ["written pi"]),
    "if": (left(Motion="if(t>.5, 1, 0); 0; 0"), ["c ? a : b"]),
    "modulo": (left(Motion="mod(t, 1); 0; 0"), ["t - floor(t)"]),
    "brackets around formulas": (left(Motion="(0; 0; t)"), ["No brackets"]),
    "empty formula": (left(Motion="0;; t"), ["Write 0"]),
    "minus of a typesetter": (left(Motion="0; 0; −t"), ["minus is -"]),
    # selections
    "box by commas": (left(Select="box 0, -1, -1, .1, 1, 1"), ["6 numbers", "separated by blanks", "'box 0 -1 -1 .1 1 1'"]),
    "box with decimal commas": (left(Select="box 0,0 -1,5 -1,5 0,1 1,5 1,5"), ["Did you mean 'box 0.0 -1.5 -1.5 0.1 1.5 1.5'?"]),
    "components together": (left(Components="xz"), ["such as 'x, z'"]),
    "numbers alone": (left(Select="1 2 3"), ["'nodes FILE' names it"]),
    "range of nodes": (left(Select="nodes 1-5"), ["stand in a file"]),
    "box in brackets": (left(Select="box(0,-1,-1,.1,1,1)"), ["Did you mean 'box 0 -1 -1 .1 1 1'?"]),
    "kind with a capital": (left(Select="Boundary 1"), ["Did you mean 'boundary 1'?"]),
    "inequality": (left(Select="x < .1"), ["selected by a box", "Did you mean 'box -1e9 -1e9 -1e9 .1 1e9 1e9'?"]),
    "word of gmsh": (left(Select="physical 1"), ["Did you mean 'boundary 1'?"]),
    "handle without a subsection": ({**TWO, "Handles/right/Select": None, "Handles/right/Motion": None}, ["Handles/right/Select is not set", "needs a line 'set Select = boundary 1'", "write 'subsection right' before"]),
    "no id": (left(Select="boundary"), ["does not say which boundary"]),
    "two boundaries": (left(Select="boundary 1, 2"), ["one Physical Surface is selected at a time", "a subsection of its own"]),
    "name of a boundary misspelt": (left(Select="boundary X-"), ["Did you mean 'x-'"]),
    "nodes in the scene": (left(Select="nodes 1 2 3"), ["stand in a file"]),
    "nodes from 0": (left(Select="nodes from0.txt"), ["'0' in", "counted from 1: add 1 to all"]),
    "box in millimetres": (left(Select="box -1 -600 -600 3000 600 600"), ["every node", "Handles/left/Select smaller", "metres"]),
    "handle of one node": (left(Select="sphere 0 -.5 -.5 .1"), ["3 of 6", "Handle 'left' holds a single node", "Enlarge Handles/left/Select by 1.75 m"]),
    # files
    "missing mesh": ({**FILE, "Mesh/File": "baar.msh"}, ["exemplar: Mesh/File: ", "/baar.msh: cannot be opened", "Did you mean bar.msh?"]),
    "capital in a file": ({**FILE, "Mesh/File": "Bar.msh"}, ["Did you mean bar.msh?"]),
    "quoted file": ({**FILE, "Mesh/File": '"bar.msh"'}, ["without quotes"]),
    "home directory": ({**FILE, "Mesh/File": "~/bar.msh"}, ["Neither ~ nor $"]),
    "backslash": ({**FILE, "Mesh/File": "C:\\meshes\\bar.msh"}, ["separated by /", "Windows", "/mnt/c/meshes/bar.msh"]),
    "ending left out": ({**FILE, "Mesh/File": "bar"}, ["Did you mean bar.msh?"]),
    "missing surface": ({**FILE, "Mesh/File": "cub.obj"}, ["/cub.obj: cannot be opened", "Did you mean cube.obj?"]),
    "missing pose": ({**FILE, "Mesh/File": "bar.msh", "Examples/Poses": "ber.msh"}, ["Examples/Poses: ", "/ber.msh: cannot be opened", "path of a pose: a mesh (.msh, ", "), or a surface.\n"]),
    "missing pose to follow": (left(**{"Follow pose": "smal.msh"}), ["Handles/left/Follow pose: ", "Did you mean small.msh?"]),
    "missing directory": ({**FILE, "Mesh/File": "meshes/bar.msh"}, ["There is no directory", "/meshes."]),
    "poses by blanks": ({**FILE, "Mesh/File": "bar.msh", "Examples/Poses": "bar.msh other.msh"}, ["by commas"]),
    "poses by a pattern": ({**FILE, "Mesh/File": "bar.msh", "Examples/Poses": "b*.msh"}, ["Patterns are not replaced"]),
    "pose of another mesh": ({**BAR, "Examples/Poses": "small.msh"}, ["8 nodes, the mesh has 12", "exemplar pose"]),
}

# name, beginning of the file, words of the message where it is Mesh/File, and where it is a surface
FOREIGN = [
    ("a.vtk", "# vtk DataFile Version 3.0\n", "the file ends at line 2 before ASCII or BINARY. It is cut off", "not a surface"),
    ("a.inp", "*HEADING\n", "has no tetrahedra", "not a surface"),
    ("a.vtu", "<?xml", "a .vtu begins with <VTKFile>", "not a surface"),
    ("a.ele", "1 4 0\n", "a.node", "not a surface"),
    ("a.node", "1 3 0\n", "the number of nodes is 1, but the file has only 0 bytes left", "not a surface"),
    ("a.mesh", "MeshVersionFormatted 2\n", "before the keyword End. It is cut off", "not a surface"),
    ("a.xdmf", "<Xdmf/>", "meshio convert a.xdmf", "not a surface"),
    ("xml.xdmf", "<?xml version=\"1.0\"?>\n<Xdmf/>", "It is an XDMF file. Convert it: meshio convert xml.xdmf", "an XDMF file, not a surface"),
    ("a.npz", "PK\x03\x04", "It is an archive of numpy's arrays. Meshes are read", "arrays, not a surface"),
    ("zip.msh", "PK\x03\x04", "It is a packed file. Unpack", "It is a packed file. Unpack"),
    ("a.bdf", "GRID\n", "line 1: field 2 of GRID is ''", "not a surface"),
    ("a.unv", "    -1\n", "gmsh a.unv -save", "not a surface"),
    ("a.med", "HDF", "meshio convert a.med", "not a surface"),
    ("a.step", "ISO-10303-21;\n", "gmsh -3 a.step -format msh22 -o a.msh; its lengths are mostly millimetres", "gmsh -2 a.step -o a.stl"),
    ("a.blend", "BLENDER-v300", "Wavefront", "Wavefront"),
    ("a.fbx", "Kaydara FBX Binary", "Export the object", "Export the object"),
    ("a.abc", "Ogawa", "Export the object", "Export the object"),
    ("a.glb", "glTF", "Export the object", "Export the object"),
    ("a.usdc", "PXR-USDC", "Export the object", "Export the object"),
    ("a.off", "OFF\n", "Export the object", "Export the object"),
    ("a.msh.gz", "\x1f\x8b", "Unpack", "Unpack"),
    ("A.GEO", "Box(1)={0,0,0,1,1,1};\n", "ends in .geo", "gmsh -2"),
    ("vtk.msh", "# vtk DataFile Version 3.0\n", "It is a legacy VTK file. Call it vtk.vtk.", "not a surface"),
    ("stl.msh", "solid bar\n", "exemplar mesh", "Call it stl.stl. Tetrahedra are made inside it by exemplar mesh"),
    ("fluent.msh", "(0 \"Fluent\")\n", "meshio convert fluent.msh fluent_2.msh", "not a surface"),
    ("lfs.msh", "version https://git-lfs.github.com/spec/v1\n", "git lfs pull", "git lfs pull"),
    ("page.msh", "<!DOCTYPE html>\n", "a web page", "a web page"),
    ("a.json", "{\"nodes\": []}\n", "It is a JSON file. Meshes are read from .msh", "a JSON file, not a surface"),
    ("json.msh", "{}", "It is a JSON file.", "not a surface"),
    ("word.msh", "nodes", "expected a section such as $Nodes", "It is a mesh of tetrahedra"),
    ("empty.msh", "", "the file is empty", "the file is empty. Export the surface again"),
]

MESH = ["mesh", "--surface", "cube.obj"]
POSE = ["pose", "--mesh", "bar.msh", "--rest", "cube.obj", "--pose", "cube.obj", "--output", "p"]

# arguments (with a good scene.prm beside), words of the message
COMMANDS = [
    (["scene.prm", "Material/Young's modulus=1"], ["given by --set \"Material/Young's modulus=1\""]),
    (["scene.prm", "--set", "Importance=.3"], ["Did you mean --set \"Examples/Importance=.3\"?"]),
    (["scene.prm", "--set", "importance=.3"], ["\"Examples/Importance=.3\""]),
    (["scene.prm", "--set", "Examples.Importance=.3"], ["separated by '/'", "\"Examples/Importance=.3\""]),
    (["scene.prm", "--set", "Examples/Importance=0,3"], ["--set", "'0.3'"]),
    (["scene.prm", "--set", "Material/YoungsModulus=1"], ["--set \"Material/Young's modulus=1\""]),
    (["scene.prm", "--set", "E=1"], ["--set \"Material/Young's modulus=1\""]),
    (["scene.prm", "--set", "dt=.1"], ["\"Time/Step=.1\""]),
    (["scene.prm", "--set", "Names=a"], ["--set \"Handles/Names=a\" or --set \"Loads/Names=a\""]),
    (["scene.prm", "--set", "right/Motion=t"], ["\"Handles/right/Motion=t\""]),
    (["scene.prm", "--set", "Handles.right.Motion=t"], ["\"Handles/right/Motion=t\""]),
    (["scene.prm", "--set", "Handles/Right/Motion=t"], ["Did you mean Handles/right?"]),
    (["scene.prm", "--set", "Material/Gravity=1"], ["\"Loads/Gravity=1\""]),
    (["scene.prm", "--set", "Examples=.3"], ["Section Examples has the keys Poses"]),
    (["scene.prm", "--set", "Qwertz/Asdf=.3"], ["--print-parameters lists them"]),
    (["scene.prm", "--set", "Examples/Importance", "=", ".3"], ["no blanks around the '='"]),
    (["scene.prm", "--set", "Material/Young's", "modulus=1e5"], ["needs quotes"]),
    (["scene.prm", "Examples/Importance=.3"], ["given by --set \"Examples/Importance=.3\""]),
    (["scene.prm", "--set"], ["--set has nothing behind it", "--set \"Section/Key=value\""]),
    (["scene.prm", "--set", "Threads=4"], ["given by --threads"]),
    (["scene.prm", "--output", "~/out"], ["~ is not replaced", "write the path in full"]),
    (["scene.prm", "--output", "C:\\out"], ["path of Windows"]),
    (["scene.prm", "--set", "Handles/right/Motion=0; 0; "], ["number 3 of '0; 0;'", "Write 0 where nothing is"]),
    (["scene.prm", "--set", "Handles/right/Motion=0"], ["1 formula", "needs quotes"]),
    (["scene.prm", "--set", "Handles/right/Motion=0; 0; t*1.0m"], ["Numbers have no unit"]),
    (["scene.prm", "--set", "Handles/left/Select=box -9 -9 -9 9 9 9", "--set", "Handles/right/Motion=0; 0; t"],
     ["Handles/left/Select selects all nodes"]),
    (["scene.prm", "--set", "Handles/right/Select=boundary 1 | boundary 2"], ["boundary"]),
    (["scene.prm", "--set", "Handles/right/Select=box 0 0 0 1 1 1 | boundary 2"], ["one selection alone", "subsection of its own"]),
    (["scene.prm", "--set", "Examples/Pose functions=x; y; z; 1.1*x; y; z"], ["6 formulas", "separate these by '|'"]),
    (["scene.prm", "--outptu", "out"], ["no option '--outptu'", "Did you mean '--output'"]),
    (["scene.prm", "--ouput=out"], ["no option '--ouput'", "Did you mean '--output'"]),
    (["scene.prm", "--out", "out"], ["no option '--out'. Did you mean '--output'?"]),
    (["scene.prm", "--quiet", "--verbose"], ["--quiet", "--verbose", "give one of them"]),
    (["scene.prm", "--resume", "--output", "new"], ["no checkpoint", "Give the --output of the run that is to go on"]),
    (["scene.prm", "-o", "out"], ["no option '-o'", "Did you mean '--output'"]),
    (["scene.prm", "--Importance", ".3"], ["no option '--Importance'", "--set"]),
    (["scene.prm", "--output", ""], ["--output is empty"]),
    (["scene.prm", "--output", "a", "--output", "b"], ["--output is given twice"]),
    (["scene.prm", "other.prm"], ["Two scenes are given", "'other.prm'"]),
    (["help"], ["neither a scene nor a command", "--help lists commands"]),
    (["broken"], ["is the directory of a run", "exemplar broken/parameters.prm"]),
    (["validate", "scene.prm"], ["Did you mean '--validate'?"]),
    (["scene.prm", "--resume", "a directory"], ["is a directory", "given by --output \"a directory\""]),
    (["from0.json"], ["looks like a file of another kind"]),
    (["run", "scene.prm"], ["no command 'run'", "exemplar SCENE.prm"]),
    (["meshes", "--surface", "cube.obj"], ["no command 'meshes'", "Did you mean 'mesh'"]),
    (["stduy", "scene.prm"], ["no command 'stduy'", "Did you mean 'study'"]),
    (["study.prm", "study"], ["The command stands first"]),
    (["Scene.prm"], ["Did you mean scene.prm?"]),
    (["bar.msh"], ["a mesh or a surface, not a scene", "set File = bar.msh"]),
    (["study", "scene.prm"], ["Vary is not set", "exemplar scene.prm"]),
    (["study", "lost.prm"], ["lost.prm:1, Scene: ", "absent.prm: cannot be read"]),
    (["study", "study.prm", "--outptu", "x"], ["exemplar study has no option '--outptu'", "'--output'"]),
    (["verify", "--lits"], ["exemplar verify has no option '--lits'", "'--list'"]),
    (["verify", "scene.prm"], ["cases by their names", "run by: exemplar scene.prm"]),
    (["scene"], ["Did you mean scene.prm?"]),
    (["scene.prm", "--resume-from", "out/frame_0001.vtu"], ["number of a step", "--output names"]),
    (["pose", "--mesh", "cube.obj", "--rest", "bar.msh", "--pose", "cube.obj", "--output", "p"], ["swapped", "--mesh takes the tetrahedra"]),
    (["pose", "--mesh", "cube.obj", "--rest", "cube.obj", "--pose", "cube.obj", "--output", "p"], ["is a surface", "exemplar mesh --surface cube.obj"]),
    (["pose", "--mesh", "bar.msh", "--rest", "cube.obj", "--pose", "cube_.obj", "--output", "p"], ["cube_.obj: cannot be opened", "path of a pose: an .obj, .ply or .stl file.\n"]),
    (["pose", "--mesh", "bar.msh", "--rest", "cube.obj", "--pose", "cube.obj", "--output", "p.msh"], ["Give the name of a directory"]),
    (["verify", "patchh"], ["Did you mean 'patch'", "--list"]),
    ([*MESH, "--cell", "100", "--output", "m.msh"], ["exemplar mesh has no option '--cell'", "'--cells'"]),
    ([*MESH, "--cells", "100", "-o", "m.msh"], ["no option '-o'", "'--output'"]),
    ([*MESH, "--cells", "1e4", "--output", "m.msh"], ["--cells", "'1e4'", "whole number", "Did you mean 10000? exemplar mesh --help"]),
    ([*MESH, "--cells", "10,000", "--output", "m.msh"], ["'10,000'. Did you mean 10000?"]),
    ([*MESH, "--cells", "5", "--output", "m.msh"], ["from 10 to 10000000 in decimal digits, found '5'. exemplar mesh --help"]),
    ([*POSE, "--attach", "0"], ["found '0'. exemplar pose --help"]),
    ([*MESH, "--cells", "100"], ["--output is required", "exemplar mesh --surface"]),
    (["mesh", "--surface", "cubee.obj", "--cells", "100", "--output", "m.msh"], ["Did you mean cube.obj?"]),
    (["mesh", "cube.obj", "m.msh"], ["stands without an option", "exemplar mesh --surface"]),
    (["pose", "--mesh", "bar.msh", "--rest", "cube.obj", "--poses", "cube.obj", "--output", "p"], ["'--poses'", "Did you mean '--pose'"]),
    ([*POSE, "--cells", "100"], ["no option '--cells'", "by exemplar mesh --cells N"]),
    ([*MESH, "cube.obj", "--cells", "100", "--output", "m.msh"], ["'cube.obj' stands without an option", "given by --poses"]),
    ([*MESH, "--cells", "100", "--output", "m.msh", "--scale", ".001"], ["no option '--scale'", "Mesh/Scale"]),
    ([*MESH, "--cells", "100", "--output", "m.msh", "--list-faults", "f.csv"], ["instead of a mesh", "give one of them"]),
    (["scene.prm", "bar.msh"], ["'bar.msh' is no scene", "--set \"Mesh/File=bar.msh\""]),
    (["scene.prm", "--session", "s.txt"], ["no option '--session'", "--set Session/File=FILE"]),
    (["scene.prm", "--record", "r"], ["no option '--record'", "exemplar live SCENE.prm --record"]),
    (["scene.prm", "--mesh", "bar.msh"], ["no option '--mesh'", "--set Mesh/File=FILE"]),
    (["scene.prm", "--validate", "--resume"], ["no checkpoint", "leave out --resume"]),
    (["--print-parameters", "Time/Step"], ["--set \"Time/Step=value\"", "--print-parameters stands alone"]),
    (["session.txt"], ["a recorded session, not a scene", "Session/File"]),
    (["study", "table.csv"], ["looks like a table (.csv)"]),
    (["verify", "--case", "patch"], ["no option '--case'", "exemplar verify uniaxial patch"]),
    (["export", "a", "b", "c", "--html", "x.html"], ["one run, or two side by side", "'c' is one too many"]),
    (["export", "broken", "--output", "x.html"], ["no option '--output'", "--html FILE.html"]),
    (["export", "scene.prm", "--html", "x.html"], ["scene.prm is no directory", "output directory of a run"]),
    (["live", "scene.prm", "--output", "x"], ["'--output'", "--record DIRECTORY"]),
    (["live", "scene.prm", "--validate"], ["'--validate'", "exemplar SCENE.prm --validate"]),
    (["live", "dynamic.prm", "--floor", "nan"], ["--floor takes a finite coordinate [m]"]),
    (["live", "scene.prm", "--prot", "1"], ["'--prot'", "Did you mean '--port'"]),
    (["live", "scene.prm", "--until"], ["'--until'", "Did you mean '--until-input-ends'"]),
    (["live", "dynamic.prm", "--bind", "localhost"], ["'localhost' is no address of numbers", "127.0.0.1"]),
]


class Mistakes(BadInputTest):
    def setUp(self):
        super().setUp()
        self.write("from0.txt", "0\n1\n2\n")
        self.write("from0.json", "{}\n")
        write_obj(self.directory / "cube.obj", *cube())

    def test_scenes(self):
        for name, (scene, words) in SCENES.items():
            with self.subTest(name):
                text = prm(scene) if isinstance(scene, dict) else scene
                (self.directory / "scene.prm").write_bytes(text if isinstance(text, bytes) else text.encode())
                self.check(self.call("scene.prm", "--output", "out"), words, self.tree())

    def test_files_of_other_programs(self):
        for name, begin, of_mesh, of_surface in FOREIGN:
            with self.subTest(name):
                self.write(name, begin)
                self.write("scene.prm", prm({**FILE, "Mesh/File": name}))
                before = self.tree()
                self.check(self.call("scene.prm", "--output", "out"), [name, of_mesh], before)
                self.check(self.call("mesh", "--surface", name, "--cells", "100", "--output", "m.msh"), [name, of_surface], before)

    def test_commands(self):
        self.write("scene.prm", prm({**TWO, "Examples/Pose functions": "1.1*x; y; z"}))
        self.write("study.prm", prm({"Scene": "scene.prm", "Vary": "Time/Increments: 1 2"}))
        self.write("dynamic.prm", prm(DYNAMIC))
        self.write("session.txt", "exemplar session 1\n")
        self.write("table.csv", "Time/Increments,status\n")
        self.write("lost.prm", prm({"Scene": "absent.prm", "Vary": "Time/Increments: 1 2"}))
        before = self.tree()
        for arguments, words in COMMANDS:
            with self.subTest(arguments):
                self.check(self.call(*arguments), words, before)

    def test_names_are_relative_to_the_scene(self):
        (self.directory / "scenes").mkdir()
        self.write("scenes/scene.prm", prm({**FILE, "Mesh/File": "bar.msh"}))
        self.check(self.call("scenes/scene.prm"), ["relative to its directory", "where there is a bar.msh"], self.tree())

    def test_names_may_hold_blanks(self):
        self.write("scene.prm", prm({**BAR, "Handles/Names": "left paw", "Handles/left/Select": None, "Handles/left paw/Select": "boundary 1"}))
        self.assertEqual(self.call("scene.prm", "--validate").status, 0)


class Places(SceneTest):
    """Paths that lead nowhere are named with the system's reason, in words."""

    def test_links_in_a_ring(self):
        (self.directory / "ring").symlink_to("ring")
        scene = self.write("scene.prm", prm(BAR))
        for arguments in ([scene, "--output", "ring"], [scene, "--output", "ring/x"], ["live", "ring"], ["export", "ring", "--html", "x.html"]):
            run = self.call(*arguments)
            self.assertEqual((run.status, run.stdout), (1, ""), arguments)
            self.assertIn("ring", run.stderr)
            self.assertNotIn("filesystem error", run.stderr)

    def test_working_directory_that_is_gone(self):
        gone = self.directory / "gone"
        gone.mkdir()
        done = subprocess.run(["sh", "-c", f'cd {gone} && rmdir {gone} && "$0" "$1" --output out', EXEMPLAR, self.write("scene.prm", prm(BAR))], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (1, ""), done.stderr)
        self.assertIn("The working directory cannot be used", done.stderr)

    def test_states_that_are_not_unique_or_hardly_found(self):
        for key, value, words in (("Yield stress", "1", "more than one state"), ("Fibre stiffness", "1e11", "hundredth of the body")):
            run = self.call("--validate", self.write("scene.prm", prm({**BAR, f"Material/{key}": value, **({"Material/Fibre direction": "1; 0; 0"} if "Fibre" in key else {})})))
            self.assertEqual(run.status, 0, run.stderr)
            self.assertIn(words, " ".join(run.stderr.split()))


class Surfaces(SceneTest):
    def mesh(self, surface, *arguments):
        return self.call("mesh", "--surface", surface, *arguments)

    def test_byte_order_mark(self):
        vertices, faces = cube()
        write_obj(self.directory / "cube.obj", vertices, faces)
        (self.directory / "marked.obj").write_bytes(b"\xef\xbb\xbf" + (self.directory / "cube.obj").read_bytes())
        for name in ("cube", "marked"):
            run = self.mesh(f"{name}.obj", "--cells", "50", "--output", f"{name}.msh")
            self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual((self.directory / "cube.msh").read_bytes(), (self.directory / "marked.msh").read_bytes())
        (self.directory / "wide.obj").write_bytes((self.directory / "cube.obj").read_text().encode("utf-16"))
        self.assertIn("saved as UTF-16", self.mesh("wide.obj", "--cells", "50", "--output", "wide.msh").stderr)

    def faults(self, name, vertices, faces):
        """What the message says of a surface, and the rows of the table that it names."""
        write_obj(self.directory / f"{name}.obj", vertices, faces)
        refused = self.mesh(f"{name}.obj", "--cells", "100", "--output", "m.msh")
        self.assertEqual(refused.status, 1)
        run = self.mesh(f"{name}.obj", "--list-faults", "faults.csv")
        self.assertEqual((run.status, run.stderr), (0, ""))
        with open(self.directory / "faults.csv", newline="") as file:
            return refused.stderr, list(csv.DictReader(file))

    def test_all_bad_faces_are_listed(self):
        pairs = [joined(cube((3 * i, 0, 0)), cube((3 * i + .5, .5, .5))) for i in range(8)]
        said, rows = self.faults("crossing", *joined(*pairs))
        self.assertIn(" more)", said)
        self.assertIn("--surface crossing.obj --list-faults", said)
        self.assertEqual({row["fault"] for row in rows}, {"pairs of intersecting faces"})
        faces = [int(row["number"]) for row in rows]
        self.assertEqual(len(set(faces)), len(faces))
        self.assertEqual(f"and {len(faces) - 5} more)" in said, True, said)
        self.assertTrue(all(int(row["index"]) == int(row["number"]) - 1 and row["element"] == "face" for row in rows))

    def test_a_hole_is_listed_by_its_vertices(self):
        vertices, faces = cube()
        _, rows = self.faults("open", vertices, faces[:-1])
        self.assertEqual({int(row["index"]) for row in rows}, set(faces[-1]))
        for row in rows:
            self.assertEqual(tuple(float(row[c]) for c in "xyz"), tuple(vertices[int(row["index"])]))

    def test_faces_are_those_of_the_file(self):
        vertices, faces = cube()
        _, rows = self.faults("turned", vertices, [face[::-1] if i == 4 else face for i, face in enumerate(faces)])
        self.assertEqual([(row["fault"], row["number"]) for row in rows], [("faces turned against their neighbours", "5")])

    def test_table_elsewhere(self):
        write_obj(self.directory / "cube.obj", *cube())
        before = sorted(self.directory.iterdir())
        for arguments, words in ((["--list-faults", "faults.txt"], ".csv"), (["--list-faults", "absent/faults.csv"], "no directory")):
            run = self.mesh("cube.obj", *arguments)
            self.assertEqual(run.status, 1)
            self.assertIn(words, run.stderr)
        self.assertEqual(sorted(self.directory.iterdir()), before)
        self.assertEqual(self.mesh("cube.obj", "--list-faults", "none.csv").status, 0)
        self.assertEqual((self.directory / "none.csv").read_text().count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
