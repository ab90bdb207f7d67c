# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages of the program in the words of the panel: keys of the scene and names of files become settings, objects and shape keys."""
import re

# Keys of a scene, or what messages say of them, and what the artist sees in their place; the first that fits is taken.
WORDS = [
    (r"Loads/Balanced = true", "Balanced is on"), (r"Loads/Balanced = false", "Balanced off"), (r"Loads/Balanced", "Balanced"),
    (r"Loads/Gravity", "the scene's gravity"),
    (r"Material/Young's modulus map", "the vertex group exemplar stiffness"), (r"Material/Density map", "the vertex group exemplar density"),
    (r"Material/Importance map", "the vertex group exemplar importance"),
    (r"Material/Young's modulus", "Stiffness"), (r"Material/Density", "the density"),
    (r"Mesh/Cells", "Cells"), (r"Mesh/Repair = true", "Repair on"), (r"Mesh/Repair", "Repair"), (r"(?<!\w)--repair", "Repair"),
    (r"Mesh/Scale", "the scene's unit scale"), (r"Mesh/Carry", "what it wears"), (r"Mesh/(File|Surface)", "the body"),
    (r"Examples/Importance", "Importance"), (r"Examples/Weight maps", "Regions"), (r"Examples/Weights", "Weights"),
    (r"Examples/Poses", "the shape keys"),
    (r"Handles/follow", "Follow"), (r"Handles/pin", "Pin"), (r"Initial/Pose", "the pose of the first frame"),
    (r"(?:\()?Time/Step(?:\))?", "more Steps a frame"), (r"Time/Mass damping", "Damping"), (r"Time/Stiffness damping", "Inner damping"),
    (r"\bgroups\.csv:follow\b", "the vertex group of Follow"), (r"\bgroups\.csv:pin\b", "the vertex group of Pin"),
    (r"\bgroups\.csv:(stiffness|density|importance)\b", r"the vertex group exemplar \1"),
    (r"\brig\.mdd\b", "the motion of the rig"), (r"\b(start\.obj|pin\.mdd)\b", "the pose of the first frame"),
]


def in_artists_words(text, directory, body, shot):
    """`text` of a run in a directory; of a body, by its name, and its shot."""
    text = text.replace(f"{directory}/", "")
    text = re.sub(r"\bSmaller steps \(Time/Step\) may avoid it", "More Steps may avoid it", text)

    def name_of(found):
        kind, number = found[1], int(found[2])
        names = {"worn": [name for name, _ in shot.worn], "pose": shot.poses, "region": shot.regions}[kind]
        what = {"worn": "", "pose": "shape key ", "region": "vertex group "}[kind]
        return f"{what}'{names[number - 1]}'" if number <= len(names) else found[0]
    text = re.sub(r"(?:\bgroups\.csv:)?\b(worn|pose|region)_(\d+)\b(?:\.obj|\.msh)?", name_of, text)
    text = re.sub(r"\bbody\.(obj|msh)\b", f"'{body}'", text)
    for key, word in WORDS:
        text = re.sub(key, word, text)
    return text
