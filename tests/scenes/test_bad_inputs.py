# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad inputs: status 1, one message that says what, where, what is allowed and the remedy, and
nothing written."""

import os
import re
import unittest

from exemplar_runner import BAR, SceneTest, prm, read_msh, write_msh

STRETCH = "1.1*x; y; z"
FREE = {**BAR, "Examples/Pose functions": STRETCH}
PRESCRIBED = {**FREE, "Examples/Weights": "prescribed"}
DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Step": "0.1", "Time/End": "0.2"}
INTERPOLATION = {**BAR, "Scene": "interpolation", "Handles/Names": None,
                 "Handles/left/Select": None, "Loads/Gravity": None,
                 "Examples/Pose functions": STRETCH, "Examples/Prescribed weights": "1-t; t"}
TWO_HANDLES = {**BAR, "Handles/Names": "left, right"}
LOADED = {**BAR, "Loads/Names": "tip", "Loads/tip/Select": "boundary 2"}
FILE = {**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None}

LINES = len(prm(BAR).splitlines())

# name, scene (text or keys), what stderr must contain
SCENES = [
    # the file itself
    ("misspelt key", {**BAR, "Material/Youngs modulus": "1e6"},
     ["scene.prm:", "'Material/Youngs modulus'", "Did you mean 'Material/Young's modulus'"]),
    ("misspelt subsection", {**BAR, "Materiel/Density": "1e3"},
     ["scene.prm:", "'Materiel/Density'", "Did you mean 'Material/Density'"]),
    ("key at the wrong place", "set Density = 1000\n" + prm(BAR),
     ["scene.prm:1:", "'Density'", "Did you mean"]),
    ("duplicate key", prm(BAR) + "subsection Mesh\nset Generator = box\nend\n",
     [f"scene.prm:{LINES + 2}:", "Mesh/Generator is set twice", "scene.prm:3", "Keep one"]),
    ("unterminated subsection", prm(BAR) + "subsection Solver\nset Method = one pass\n",
     [f"scene.prm:{LINES + 2}:", "subsection 'Solver'", "'end'"]),
    ("one 'end' too many", prm(BAR) + "end\n", [f"scene.prm:{LINES + 1}:", "'end'", "Remove"]),
    ("line without =", prm(BAR) + "set Scene\n",
     [f"scene.prm:{LINES + 1}:", "'='", "set KEY = VALUE"]),
    ("no prm line", prm(BAR) + "Scene static\n",
     [f"scene.prm:{LINES + 1}:", "'Scene static'", "set KEY = VALUE"]),
    ("Scene not set", {**BAR, "Scene": None}, ["scene.prm", "Scene is not set", "set Scene ="]),
    ("empty file", "", ["scene.prm", "Scene is not set", "set Scene ="]),

    # types and ranges
    ("unknown scene", {**BAR, "Scene": "statics"},
     ["scene.prm:1:", "Scene = 'statics'", "interpolation, static, dynamic"]),
    ("wrong type", {**BAR, "Time/Increments": "two"},
     ["scene.prm:", "Time/Increments = 'two'", "Allowed: an integer >= 1", "Default: '10'"]),
    ("word for a number", {**BAR, "Material/Density": "heavy"},
     ["Material/Density = 'heavy'", "Allowed: a number"]),
    ("number with a unit", {**BAR, "Material/Density": "1000 kg"},
     ["Material/Density = '1000 kg'", "Allowed: a number"]),
    ("out of range", {**FREE, "Examples/Importance": "1.5"},
     ["scene.prm:", "Examples/Importance = '1.5'", "Allowed: a number in 0 ... 1"]),
    ("Young's modulus 0", {**BAR, "Material/Young's modulus": "0"},
     ["Material/Young's modulus = '0'", "Allowed: a number > 0"]),
    ("negative density", {**BAR, "Material/Density": "-1"},
     ["Material/Density = '-1'", "Allowed: a number > 0"]),
    ("Poisson's ratio 0.5", {**BAR, "Material/Poisson's ratio": "0.5"},
     ["Material/Poisson's ratio", "0.5", "strictly between -1 and 0.5", "0.49"]),
    ("Poisson's ratio -1", {**BAR, "Material/Poisson's ratio": "-1"},
     ["Material/Poisson's ratio", "-1", "strictly between -1 and 0.5"]),
    ("Poisson's ratio 0.6", {**BAR, "Material/Poisson's ratio": "0.6"},
     ["Material/Poisson's ratio = '0.6'", "0.5"]),
    ("Poisson's ratio 0.5 in a region", {**BAR, "Material/region 1/Poisson's ratio": "0.5"},
     ["Material/region 1/Poisson's ratio", "strictly between"]),
    ("Step = nan", {**DYNAMIC, "Time/Step": "nan"}, ["Time/Step = 'nan'", "Allowed: a number > 0"]),
    ("Step = inf", {**DYNAMIC, "Time/Step": "inf"}, ["Time/Step = 'inf'", "Allowed: a number > 0"]),
    ("Step = 1e999", {**DYNAMIC, "Time/Step": "1e999"}, ["Time/Step = '1e999'", "Allowed: a numb"]),
    ("negative step", {**DYNAMIC, "Time/Step": "-0.1"},
     ["Time/Step = '-0.1'", "Allowed: a number > 0"]),
    ("step 0", {**DYNAMIC, "Time/Step": "0"}, ["Time/Step = '0'", "Allowed: a number > 0"]),
    ("End = 0", {**DYNAMIC, "Time/End": "0"}, ["Time/End = '0'", "Allowed: a number > 0"]),
    ("too many steps", {**DYNAMIC, "Time/Step": "1e-12"}, ["Time/Step", "1e9 steps", "Enlarge"]),
    ("Increments = 0", {**BAR, "Time/Increments": "0"},
     ["Time/Increments = '0'", "Allowed: an integer >= 1"]),
    ("negative Every", {**BAR, "Output/Every": "-1"},
     ["Output/Every = '-1'", "Allowed: an integer >= 0"]),
    ("Maximum iterations = 0", {**BAR, "Solver/Maximum iterations": "0"},
     ["Solver/Maximum iterations = '0'", "Allowed: an integer >= 1"]),
    ("Tolerance = nan", {**BAR, "Solver/Tolerance": "nan"},
     ["Solver/Tolerance = 'nan'", "Allowed: a number in 1e-16 ... 1"]),
    ("unknown strain", {**BAR, "Model/Strain": "lineal"},
     ["Model/Strain = 'lineal'", "corotational, linear, green"]),
    ("unknown time scheme", {**BAR, "Time/Scheme": "bdf3"},
     ["Time/Scheme = 'bdf3'", "implicit euler, bdf2"]),
    ("negative damping", {**BAR, "Time/Stiffness damping": "-1"}, ["Time/Stiffness damping"]),
    ("unknown method", {**BAR, "Solver/Method": "newtons"},
     ["Solver/Method = 'newtons'", "one pass, fixed point"]),
    ("no boolean", {**FREE, "Examples/Include rest pose": "maybe"},
     ["Examples/Include rest pose = 'maybe'", "true or false"]),
    ("gravity with two components", {**BAR, "Loads/Gravity": "0, -9.81"},
     ["Loads/Gravity = '0, -9.81'", "three numbers separated by commas"]),
    ("gravity nan", {**BAR, "Loads/Gravity": "0, nan, 0"},
     ["Loads/Gravity = '0, nan, 0'", "three numbers separated by commas"]),

    # the mesh
    ("no mesh", FILE, ["no mesh is given", "Mesh/File", "Mesh/Generator = box"]),
    ("two meshes", {**BAR, "Mesh/File": "bar.msh"},
     ["both File and Generator", "Mesh/File", "Mesh/Generator"]),
    ("missing mesh", {**FILE, "Mesh/File": "absent.msh"}, ["/absent.msh", "cannot be opened"]),
    ("mesh is a directory", {**FILE, "Mesh/File": "a directory"}, ["/a directory", "directory"]),
    ("truncated mesh", {**FILE, "Mesh/File": "truncated.msh"},
     ["/truncated.msh", "within section $Elements", "truncated", "Copy it again"]),
    ("mesh is no .msh", {**FILE, "Mesh/File": "scene.prm"},
     ["/scene.prm", "expected a section", "'set'", ".msh"]),
    ("missing .geo", {**FILE, "Mesh/File": "absent.geo"}, ["/absent.geo", "cannot be opened"]),
    ("Box cells = 0", {**BAR, "Mesh/Box cells": "2, 0, 1"},
     ["Mesh/Box cells = '2, 0, 1'", "three integers >= 1 separated by commas"]),
    ("Box size = 0", {**BAR, "Mesh/Box size": "2, 0, 1"}, ["Mesh/Box size", "positive"]),
    ("Scale = 0", {**BAR, "Mesh/Scale": "0"}, ["Mesh/Scale", "positive"]),
    ("absent region", {**BAR, "Material/region 7/Density": "2000"},
     ["Material/region 7", "material id 7", "present: 1", "Physical Volume"]),
    ("misspelt region", {**BAR, "Material/Region 1/Density": "2000"},
     ["scene.prm:", "Material/Region 1", "'region ID'"]),

    # examples
    ("missing pose", {**BAR, "Examples/Poses": "absent.msh"}, ["/absent.msh", "cannot be opened"]),
    ("pose is no .msh", {**BAR, "Examples/Poses": "scene.prm"},
     ["/scene.prm", "expected a section", "'set'", ".msh"]),
    ("pose is a directory", {**BAR, "Examples/Poses": "a directory"},
     ["/a directory", "directory"]),
    ("pose with fewer nodes", {**BAR, "Examples/Poses": "small.msh"},
     ["/small.msh", "8 nodes, the mesh has 12", "final.msh"]),
    ("pose of another connectivity", {**BAR, "Examples/Poses": "other.msh"},
     ["/other.msh", "tetrahedron 2 ", "in the mesh", "final.msh"]),
    ("pose function of two components", {**BAR, "Examples/Pose functions": "x; y"},
     ["Examples/Pose functions = 'x; y'", "2 formulas", "needs 3", "';'"]),
    ("pose function of t", {**BAR, "Examples/Pose functions": "x*t; y; z"},
     ["Examples/Pose functions", "'x*t'", "variables x, y, z"]),
    ("weights that do not sum to one", {**PRESCRIBED, "Examples/Prescribed weights": "1-t; 2*t"},
     ["Examples/Prescribed weights", "sum to 1.5 at t = 0.5", "not to 1"]),
    ("no prescribed weights", PRESCRIBED,
     ["Examples/Prescribed weights is empty", "one function of t for each example", "1-t; t"]),
    ("too many prescribed weights", {**PRESCRIBED, "Examples/Prescribed weights": "1-t; t; 0"},
     ["Examples/Prescribed weights", "3 formulas", "needs 2"]),
    ("weights that nobody uses", {**FREE, "Examples/Prescribed weights": "1-t; t"},
     ["Examples/Prescribed weights", "Examples/Weights", "'prescribed'"]),
    ("Weight penalty 'abc'", {**FREE, "Examples/Weight penalty": "abc"},
     ["Examples/Weight penalty = 'abc'", "auto, paper or a number"]),
    ("negative Weight penalty", {**FREE, "Examples/Weight penalty": "-1"},
     ["Examples/Weight penalty = '-1'", "auto, paper or a number"]),
    ("dependent examples without penalty",
     {**BAR, "Examples/Pose functions": f"{STRETCH} | 1.2*x; y; z", "Examples/Weight penalty": "0"},
     ["Example 2", "1.2*x; y; z", "affine combination", "Examples/Weight penalty"]),
    ("example that is the rest pose",
     {**BAR, "Examples/Pose functions": "x; y; z", "Examples/Weight penalty": "0"},
     ["Example 1", "affine combination", "Examples/Pose functions"]),

    ("blend length without regions", {**FREE, "Examples/Region blend length": "0.1"},
     ["Examples/Region blend length", "Examples/Weights per region"]),
    ("negative blend length", {**FREE, "Examples/Weights per region": "true",
                               "Examples/Region blend length": "-1"},
     ["Examples/Region blend length"]),
    ("prescribed weights of two regions where there is one",
     {**PRESCRIBED, "Examples/Weights per region": "true",
      "Examples/Prescribed weights": "1-t; t | 1; 0"},
     ["Examples/Prescribed weights", "2 lists", "1 regions"]),
    ("prescribed weights of regions without regions",
     {**PRESCRIBED, "Examples/Prescribed weights": "1-t; t | 1; 0"},
     ["Examples/Prescribed weights", "2 lists", "Examples/Weights per region is false"]),

    # handles and loads
    ("handles that hold everything", {**BAR, "Handles/left/Select": "box -9 -9 -9 9 9 9"},
     ["hold every node", "Handles/NAME/Select"]),
    ("duplicate handle name", {**BAR, "Handles/Names": "left, left"},
     ["Handles/Names", "'left' twice", "differ"]),
    ("empty handle name", {**BAR, "Handles/Names": "left,,right"},
     ["Handles/Names", "'' is no name", "letters"]),
    ("handle not in Names", {**BAR, "Handles/right/Select": "boundary 2"},
     ["scene.prm:", "Handles/right", "not in Handles/Names", "left", "Add it"]),
    ("load not in Names", {**BAR, "Loads/tip/Force": "0; 0; 1"},
     ["scene.prm:", "Loads/tip", "not in Loads/Names", "Add it"]),
    ("misspelt handle key", {**BAR, "Handles/left/Motions": "0; 0; 0"},
     ["scene.prm:", "'Handles/left/Motions'", "Did you mean 'Handles/left/Motion'"]),
    ("handle without Select", {**BAR, "Handles/left/Select": None},
     ["Handles/left/Select", "is not set", "box x0 y0 z0 x1 y1 z1"]),
    ("unknown Select word", {**BAR, "Handles/left/Select": "cylinder 0 0 0 1"},
     ["Handles/left/Select = 'cylinder 0 0 0 1'", "sphere x y z r"]),
    ("box with 5 numbers", {**BAR, "Handles/left/Select": "box 0 0 0 1 1"},
     ["Handles/left/Select = 'box 0 0 0 1 1'", "6 numbers", "box x0 y0 z0 x1 y1 z1"]),
    ("box with a word", {**BAR, "Handles/left/Select": "box 0 0 0 1 1 top"},
     ["Handles/left/Select = 'box 0 0 0 1 1 top'", "6 numbers"]),
    ("fractional boundary id", {**BAR, "Handles/left/Select": "boundary 1.5"},
     ["Handles/left/Select = 'boundary 1.5'", "whole number"]),
    ("boundary id beyond all numbers", {**BAR, "Handles/left/Select": "boundary 1e20"},
     ["Handles/left/Select = 'boundary 1e20'", "whole number"]),
    ("handle that selects nothing", {**BAR, "Handles/left/Select": "sphere 5 5 5 1"},
     ["Handles/left/Select = 'sphere 5 5 5 1'", "selects no node", "0 -0.5 -0.5  2 0.5 0.5"]),
    ("boundary without faces", {**BAR, "Handles/left/Select": "boundary 9"},
     ["Handles/left", "boundary id 9", "present: 1, 2, 3, 4, 5, 6", "Physical Surface"]),
    ("region without cells", {**BAR, "Handles/left/Select": "region 9"},
     ["Handles/left", "region 9", "present: 1", "Physical Volume"]),
    ("no file of nodes", {**BAR, "Handles/left/Select": "nodes absent.txt"},
     ["Handles/left/Select", "/absent.txt", "cannot be read", "one a line"]),
    ("file of nodes is a directory", {**BAR, "Handles/left/Select": "nodes a directory"},
     ["Handles/left/Select", "/a directory", "cannot be read", "one a line"]),
    ("empty file of nodes", {**BAR, "Handles/left/Select": "nodes empty.txt"},
     ["Handles/left/Select", "/empty.txt", "no node number", "one a line"]),
    ("wrong node number", {**BAR, "Handles/left/Select": "nodes nodes.txt"},
     ["Handles/left/Select", "'77'", "nodes.txt", "no node number"]),
    ("unknown components", {**BAR, "Handles/left/Components": "x, w"},
     ["Handles/left/Components = 'x, w'", "x, y, z"]),
    ("no components", {**BAR, "Handles/left/Components": ""},
     ["Handles/left/Components = ''", "x, y, z"]),
    ("motion of two components", {**BAR, "Handles/left/Motion": "0; 0"},
     ["Handles/left/Motion = '0; 0'", "2 formulas", "needs 3"]),
    ("unknown function", {**BAR, "Handles/left/Motion": "sinus(t); 0; 0"},
     ["Handles/left/Motion", "'sinus(t)'", "sinus", "sin, cos"]),
    ("assignment in a formula", {**BAR, "Handles/left/Motion": "0; 0; t=0.5 ? 1 : 0"},
     ["Handles/left/Motion", "single '='", "Write =="]),
    ("rotations from velocities that are not there", {**BAR, "Solver/Rotations": "predicted"},
     ["Solver/Rotations = predicted", "Scene = dynamic"]),
    ("newton with frozen forces", {**BAR, "Solver/Method": "newton", "Model/Gradient": "frozen"},
     ["Solver/Method = newton", "Model/Gradient = consistent"]),
    ("umfpack with newton", {**BAR, "Solver/Linear solver": "umfpack"},
     ["Solver/Linear solver = umfpack", "cholesky"]),
    ("pose to follow and a motion",
     {**BAR, "Handles/left/Follow pose": "bar.msh", "Handles/left/Motion": "0; 0; t"},
     ["Handles/left/Follow pose and Handles/left/Motion = '0; 0; t'", "only one", "Remove"]),
    ("progress without a pose to follow", {**BAR, "Handles/left/Progress": "t^2"},
     ["Handles/left/Progress = 't^2'", "no Handles/left/Follow pose", "remove Progress"]),
    ("progress that depends on x",
     {**BAR, "Handles/left/Follow pose": "bar.msh", "Handles/left/Progress": "x*t"},
     ["Handles/left/Progress", "'x*t'", "variables t"]),
    ("progress that gives inf",
     {**BAR, "Handles/left/Follow pose": "bar.msh", "Handles/left/Progress": "1/t"},
     ["Handles/left/Progress", "'1/t'", "not finite at t = 0"]),
    ("no pose to follow", {**BAR, "Handles/left/Follow pose": "absent.msh"},
     ["Handles/left/Follow pose", "/absent.msh", "cannot be opened"]),
    ("pose to follow is a directory", {**BAR, "Handles/left/Follow pose": "a directory"},
     ["Handles/left/Follow pose", "/a directory", "directory"]),
    ("pose to follow of another mesh", {**BAR, "Handles/left/Follow pose": "small.msh"},
     ["Handles/left/Follow pose", "/small.msh", "8 nodes, the mesh has 12", "final.msh"]),
    ("unbalanced formula", {**BAR, "Handles/left/Motion": "(t; 0; 0"},
     ["Handles/left/Motion", "'(t'", "not understood"]),
    ("formula that gives nan", {**BAR, "Handles/left/Motion": "sqrt(-1-x); 0; 0"},
     ["Handles/left/Motion", "'sqrt(-1-x)'", "not finite", "max()"]),
    ("handles that disagree",
     {**TWO_HANDLES, "Handles/right/Select": "box 0 0 0 2 1 1", "Handles/right/Motion": "t; 0; 0"},
     ["Handles 'left' and 'right'", "node 10", "differently at t = 0.5", "Handles/right/Select"]),
    ("load on nothing", {**LOADED, "Loads/tip/Select": "box 5 5 5 6 6 6"},
     ["Loads/tip/Select = 'box 5 5 5 6 6 6'", "selects no node"]),
    ("load that gives inf", {**LOADED, "Loads/tip/Force": "1/t; 0; 0"},
     ["Loads/tip/Force", "'1/t'", "not finite at t = 0"]),
    ("load on x", {**LOADED, "Loads/tip/Force": "x; 0; 0"},
     ["Loads/tip/Force", "'x'", "variables t"]),

    # scenes that make no sense
    ("static scene without handles", {**BAR, "Handles/Names": None, "Handles/left/Select": None},
     ["scene.prm", "6 of 6 rigid motions free", "Handles"]),
    ("static scene on one roller", {**BAR, "Handles/left/Components": "x"},
     ["scene.prm", "3 of 6 rigid motions free", "Components"]),
    ("interpolation with handles", {**INTERPOLATION, **BAR, "Scene": "interpolation"},
     ["interpolation has neither handles nor loads", "Remove", "static"]),
    ("interpolation without poses", {**INTERPOLATION, "Examples/Pose functions": None},
     ["interpolation needs example poses", "Examples/Poses"]),
    ("interpolation with Importance 0.5", {**INTERPOLATION, "Examples/Importance": "0.5"},
     ["scene.prm:", "Examples/Importance = 0.5", "Importance = 1", "Remove the line"]),
    ("interpolation with free weights", {**INTERPOLATION, "Examples/Weights": "free"},
     ["scene.prm:", "Examples/Weights = free", "Weights = prescribed", "Remove the line"]),
    ("interpolation without weights", {**INTERPOLATION, "Examples/Prescribed weights": None},
     ["Examples/Prescribed weights is empty", "1-t; t"]),
    ("two initial poses", {**BAR, "Initial/Pose": "small.msh", "Initial/Pose function": STRETCH},
     ["Initial/Pose and Initial/Pose function", "Keep one"]),
    ("initial pose of another mesh", {**BAR, "Initial/Pose": "small.msh"},
     ["/small.msh", "8 nodes, the mesh has 12"]),
    ("initial pose that gives nan", {**BAR, "Initial/Pose function": "log(-x); y; z"},
     ["Initial/Pose function", "'log(-x)'", "not finite"]),
    ("velocity of four components", {**DYNAMIC, "Initial/Velocity": "0; 0; 0; 0"},
     ["Initial/Velocity", "4 formulas", "needs 3"]),
]

# name, arguments after a good scene.prm, what stderr must contain
COMMANDS = [
    ("missing scene", ["absent.prm"], ["absent.prm", "cannot be read", "existing .prm"]),
    ("scene is a directory", ["a directory"], ["a directory", "cannot be read", "existing .prm"]),
    ("no scene", [], ["SCENE is required", "--help"]),
    ("unknown option", ["scene.prm", "--outputs", "out"], ["--outputs", "--help"]),
    ("two scenes", ["scene.prm", "scene.prm"], ["scene.prm", "--help"]),
    ("--set without =", ["scene.prm", "--set", "Time/Increments"],
     ["--set 'Time/Increments'", "'='", "Section/Key=value"]),
    ("--set without key", ["scene.prm", "--set", "=3"], ["--set '=3'", "Section/Key=value"]),
    ("--set without value", ["scene.prm", "--set"], ["--set", "--help"]),
    ("--set of an unknown key", ["scene.prm", "--set", "Time/Increment=3"],
     ["--set", "'Time/Increment'", "Did you mean 'Time/Increments'"]),
    ("--set of a bad value", ["scene.prm", "--set", "Time/Increments=x"],
     ["--set", "Time/Increments = 'x'", "Allowed: an integer"]),
    ("no threads", ["scene.prm", "--threads", "0"], ["--threads", "0", "1 to 1024", "--help"]),
    ("threads in words", ["scene.prm", "--threads", "all"], ["--threads", "all", "1 to 1024"]),
    ("--resume without checkpoint", ["scene.prm", "--output", "out", "--resume"],
     ["out/checkpoint.bin", "no checkpoint", "without --resume"]),
    ("--resume from a broken checkpoint", ["scene.prm", "--output", "broken", "--resume"],
     ["broken/checkpoint.bin", "cannot be read as a checkpoint", "without --resume"]),
    ("output directory of others", ["scene.prm", "--output", "a directory"],
     ["a directory", "not empty", "not written by exemplar", "--output"]),
    ("output directory is a file", ["scene.prm", "--output", "small.msh"],
     ["small.msh", "is a file", "--output"]),
    ("output below a file", ["scene.prm", "--output", "small.msh/out"],
     ["small.msh/out", "is a file", "--output"]),
    ("output where nobody can write", ["scene.prm", "--output", "/proc/exemplar/out"],
     ["/proc/exemplar/out", "cannot be made", "--output"]),
    ("working directory as output", ["scene.prm", "--output", "."], ["not empty", "--output"]),
    ("no study", ["study"], ["STUDY is required", "--help"]),
    ("study that is absent", ["study", "absent.prm"], ["absent.prm", "cannot be read"]),
    ("study run as a scene", ["study.prm"], ["study.prm is a study", "exemplar study study.prm"]),
    ("options of scenes in a study", ["study", "study.prm", "--set", "Time/End=1"],
     ["--set", "--help"]),
    ("output directory of others for a study",
     ["study", "study.prm", "--output", "a directory"],
     ["a directory", "not empty", "no study", "--output"]),
    ("output directory of a run for a study", ["study", "study.prm", "--output", "broken"],
     ["broken", "not empty", "no study", "--output"]),
    ("output of a study is a file", ["study", "study.prm", "--output", "small.msh"],
     ["small.msh", "is a file", "--output"]),
    ("output of a study where nobody can write",
     ["study", "study.prm", "--output", "/proc/exemplar/out"],
     ["/proc/exemplar/out", "cannot be made", "--output"]),
    ("--validate of a bad scene", ["bad.prm", "--validate"], ["Scene = 'statics'"]),
]

STUDY = {"Scene": "scene.prm", "Vary": "Time/Increments: 1 2"}

# name, study (text or keys), what stderr must contain
STUDIES = [
    ("unknown key of a study", {**STUDY, "Repeat": "2"},
     ["study.prm:", "'Repeat'", "Did you mean 'Repeats'"]),
    ("a scene", prm(BAR), ["study.prm", "Vary is not set", "set Vary ="]),
    ("no scene in a study", {**STUDY, "Scene": None}, ["study.prm", "Scene is not set"]),
    ("absent scene of a study", {**STUDY, "Scene": "absent.prm"},
     ["/absent.prm", "cannot be read", "existing .prm"]),
    ("bad scene of a study", {**STUDY, "Scene": "bad.prm"}, ["Scene = 'statics'"]),
    ("unknown key in Vary", {**STUDY, "Vary": "Time/Increment: 1 2"},
     ["study.prm:2, Vary", "'Time/Increment'", "Did you mean 'Time/Increments'"]),
    ("unknown key in Base", {**STUDY, "Base": "Time/Ends=1"},
     ["study.prm:3, Base", "'Time/Ends'", "Did you mean 'Time/End'"]),
    ("unknown key in Reference", {**STUDY, "Reference": "Time/Ends=1"},
     ["study.prm:3, Reference", "'Time/Ends'", "Did you mean 'Time/End'"]),
    ("unknown handle in Vary", {**STUDY, "Vary": "Handles/top/Motion: t"},
     ["study.prm:2, Vary", "Handles/top", "not in Handles/Names"]),
    ("axis without values", {**STUDY, "Vary": "Time/Increments:"},
     ["study.prm:2, Vary", "Time/Increments has no values", "Section/Key: value"]),
    ("axis without colon", {**STUDY, "Vary": "Time/Increments 1 2"},
     ["study.prm:2, Vary", "no ':'", "Section/Key: value"]),
    ("assignment without =", {**STUDY, "Base": "Time/End"},
     ["study.prm:3, Base", "'Time/End'", "no '='", "Section/Key=value"]),
    ("key in Base and Vary", {**STUDY, "Base": "Time/Increments=3"},
     ["study.prm:3, Base", "Time/Increments", "Vary varies it", "Remove"]),
    ("output of a study's runs", {**STUDY, "Base": "Output/Directory=x"},
     ["study.prm:3, Base", "Output/Directory", "Remove", "--output"]),
    ("refused reference", {**STUDY, "Reference": "Material/Poisson's ratio=0.6"},
     ["study.prm:3, Reference", "Material/Poisson's ratio = '0.6'", "0.5"]),
    ("all runs refused", {**STUDY, "Vary": "Material/Poisson's ratio: 0.6 0.7"},
     ["study.prm:2, Vary", "Material/Poisson's ratio = '0.6'", "0.5"]),
    ("mesh of a study", {**STUDY, "Base": "Mesh/Generator=none; Mesh/File=absent.msh",
                         "Reference": "Time/Increments=9"}, ["/absent.msh", "cannot be opened"]),
    ("no repeats", {**STUDY, "Repeats": "0"}, ["Repeats = '0'", "an integer >= 1"]),
    ("negative timeout", {**STUDY, "Timeout": "-1"}, ["Timeout = '-1'", "a number >= 0"]),
]

# What a crash, a deal.II exception or a C++ library would print.
NO_MESSAGE = re.compile(r"-----|terminate|what\(\)|std::|dealii|Exemplar::|An error occurred|"
                        r"filesystem error|backtrace|\(core dumped\)")


class BadInputs(SceneTest):
    def setUp(self):
        super().setUp()
        for name in ("a directory", "broken"):
            (self.directory / name).mkdir()
        self.write("a directory/letter.txt", "not of exemplar\n")
        self.write("broken/parameters.prm", "# exemplar: all parameters in force\n")
        (self.directory / "broken/checkpoint.bin").write_bytes(b"\x16\0\0\0\0\0\0\0serialization"
                                                               b"::archive" + b"\xff" * 200)
        self.write("empty.txt", "")
        self.write("nodes.txt", "1\n77\n")
        self.write("bad.prm", prm({**BAR, "Scene": "statics"}))
        small = self.write_box({**BAR, "Mesh/Box cells": "1, 1, 1"}, "small.msh")
        self.assertEqual(len(small.nodes), 8)
        bar = self.write_box(BAR, "bar.msh")
        text = (self.directory / "bar.msh").read_text()
        self.write("truncated.msh", text[:text.index("$EndElements") - 30])
        tetrahedra = [i for i, element in enumerate(bar.elements) if element[1] == 4]
        i, j = tetrahedra[1:3]
        bar.elements[i], bar.elements[j] = bar.elements[j], bar.elements[i]
        write_msh(self.directory / "other.msh", bar)

    def tree(self):
        """Every file below the working directory, with its content."""
        return {file: file.read_bytes() if file.is_file() else None
                for file in self.directory.rglob("*")}

    def check(self, run, expected, before):
        self.assertEqual(run.status, 1, run.stderr)
        self.assertEqual(run.stdout, "")
        lines = run.stderr.splitlines()
        self.assertEqual(len(lines), 1, run.stderr)
        self.assertTrue(lines[0].startswith("exemplar: "), run.stderr)
        self.assertEqual(run.stderr.count("exemplar: "), 1, run.stderr)
        self.assertNotRegex(run.stderr, NO_MESSAGE)
        for words in expected:
            self.assertIn(words, run.stderr)
        self.assertEqual(self.tree(), before)

    def test_scenes(self):
        for name, scene, expected in SCENES:
            with self.subTest(name):
                self.write("scene.prm", scene if isinstance(scene, str) else prm(scene))
                before = self.tree()
                self.check(self.attempt(scene), expected, before)

    def test_commands(self):
        self.write("scene.prm", prm(BAR))
        self.write("study.prm", prm(STUDY))
        before = self.tree()
        for name, arguments, expected in COMMANDS:
            with self.subTest(name):
                self.check(self.call(*arguments), expected, before)

    def test_studies(self):
        self.write("scene.prm", prm(BAR))
        for name, study, expected in STUDIES:
            with self.subTest(name):
                self.write("study.prm", study if isinstance(study, str) else prm(study))
                before = self.tree()
                self.check(self.call("study", "study.prm"), expected, before)
                if "Vary" in study:
                    self.check(self.call("--validate", "study.prm"), expected, before)

    def test_the_scenes_that_the_table_changes_are_good(self):
        weights = {"Examples/Prescribed weights": "1-t; t"}
        for scene in (BAR, FREE, {**PRESCRIBED, **weights}, DYNAMIC, INTERPOLATION, LOADED,
                      {**FILE, "Mesh/File": "bar.msh"}, {**BAR, "Initial/Pose": "bar.msh"},
                      {**BAR, "Handles/left/Follow pose": "bar.msh"},
                      {**TWO_HANDLES, "Handles/right/Select": "boundary 2"}):
            with self.subTest(scene):
                self.write("scene.prm", prm(scene))
                run = self.call("scene.prm", "--validate")
                self.assertEqual((run.status, run.stderr), (0, ""))

    @unittest.skipIf(os.geteuid() == 0, "root writes everywhere")
    def test_output_without_the_right_to_write(self):
        locked = self.directory / "locked"
        locked.mkdir(mode=0o555)
        self.write("scene.prm", prm(BAR))
        self.check(self.call("scene.prm", "--output", "locked/out"),
                   ["locked/out", "no right to write", "--output"], self.tree())

    def test_resume_of_a_changed_scene(self):
        # the pose is an example, too, but not in use
        scene = {**FILE, "Mesh/File": "bar.msh", "Handles/left/Select": "nodes held.txt",
                 "Handles/left/Follow pose": "pose.msh",
                 "Examples/Poses": "pose.msh", "Examples/Importance": "0"}
        nodes = read_msh(self.directory / "bar.msh").nodes
        self.write("pose.msh", (self.directory / "bar.msh").read_text())
        self.write("held.txt", "\n".join(str(n) for n, x in nodes.items() if x[0] == 0))
        good = prm(scene)
        self.solve(good)

        def refused(expected, text=good):
            self.write("scene.prm", text)
            before = self.tree()
            self.check(self.attempt(text, "--resume"), ["out/checkpoint.bin", *expected], before)

        refused(["Material/Density was '1000' and is now '1001'", "Change it back",
                 "Only Time/End"], prm({**scene, "Material/Density": "1001"}))
        refused(["Handles/left/Progress was 't' and is now 't^2'"],
                prm({**scene, "Handles/left/Progress": "t^2"}))
        refused(["Material/region 1/Density was '(absent)' and is now '1000'"],
                prm({**scene, "Material/region 1/Density": "1000"}))
        for file in ("bar.msh", "held.txt", "pose.msh"):
            original = (self.directory / file).read_text()
            self.write(file, original + "\n")
            refused([f"/{file} has changed"])
            self.write(file, original)
        with open(self.directory / "out/statistics.csv", "r+") as statistics:
            statistics.truncate(10)
        self.check(self.attempt(good, "--resume"), ["out/statistics.csv", "without --resume"],
                   self.tree())

    def test_resume_beyond_the_end(self):
        self.solve(DYNAMIC)
        changed = prm({**DYNAMIC, "Time/End": "0.1"})
        self.write("scene.prm", changed)
        self.check(self.attempt(changed, "--resume"), ["t = 0.2", "Time/End = 0.1", "later end"],
                   self.tree())


if __name__ == "__main__":
    unittest.main()
