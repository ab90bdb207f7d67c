# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages of the program in the words of the panel: keys of the scene and names of files become settings, objects and shape keys."""
import re

# Keys of a scene, or what messages say of them, and what the artist sees in their place; the first that fits is taken.
WORDS = [
    (r"[Ss]maller steps \(?Time/Step\)?", "more Steps"), (r"Smaller steps", "More Steps"), (r"smaller steps", "more Steps"),
    (r"; for a table of all: exemplar mesh --surface .* --list-faults FAULTS\.csv", ""),
    (r"Make the mesh with poses that part them \(exemplar mesh --poses\), or of more cells", "Take more Cells"),
    (r"Make a mesh of more cells \(--cells, Mesh/Cells\)", "Take more Cells"),
    (r"Give a pose in which they are apart \(--poses\)", "Give a shape key in which they are apart"),
    (r"Give a pose that is nearer to rest \(--poses\), or ask for another number of cells", "Give a shape key that is nearer to rest, or other Cells"),
    (r", and those of regions and maps alike", ""), (r"Young's modulus is in Pa", "Stiffness is in Pa"),
    (r"Loads/Balanced = true", "Balanced is on"), (r"set Loads/Balanced = false", "switch Balanced off"), (r"Loads/Balanced", "Balanced"),
    (r"Loads/Gravity", "the scene's gravity"),
    (r"Material/(?:Young's modulus|Density|Importance) map", "the painted vertex group"),
    (r"Material/Young's modulus", "Stiffness"), (r"Material/Density", "the density"),
    (r"Mesh/Cells", "Cells"), (r"Mesh/Repair = true|(?<!\w)--repair", "Repair"), (r"Mesh/Repair", "Repair"),
    (r"Mesh/Scale", "the scene's unit scale"), (r"Mesh/Carry", "what it wears"), (r"Mesh/(?:File|Surface)", "the body"),
    (r"Examples/Importance", "Importance"), (r"Examples/Weight maps", "Regions"), (r"Examples/Weights file", "the keyed weights"),
    (r"Examples/Weights", "Weights"),
    (r"Examples/Poses", "the shape keys"),
    (r"Contact/Bodies = true keeps pieces of the mesh out of each other, but it is in one piece\. .*", "More bodies: these have "
     "become one piece. Switch Repair off, and part them in Blender."),
    (r"set Contact/Self and Contact/Bodies = false", "part them"), (r"Contact/Self = true", "Touches itself"), (r"Contact/Self", "Touches itself"),
    (r"Contact/Bodies", "More bodies"), (r"Contact/Friction", "the friction of Collision physics"),
    (r"Handles/follow", "Follow"), (r"Handles/pin", "Pin"), (r"Initial/Pose", "the pose of the first frame"),
    (r"Time/Step", "Steps"), (r"Time/Mass damping", "Damping"), (r"Time/Stiffness damping", "Inner damping"),
    (r"\bgroups\.csv:(follow|pin)\b", lambda found: f"the vertex group of {found[1].capitalize()}"),
    (r"\bgroups\.csv:(stiffness|density|importance)\b", r"the vertex group exemplar \1"),
    (r"\brig\.mdd\b", "the motion of the rig"), (r"\b(?:start\.obj|pin\.mdd)\b", "the pose of the first frame"),
    (r"Examples/Energy = scaled", "Lead"), (r"Examples/Energy = mixed", "Guide"), (r"Examples/Energy", "Lead or Guide"),
    (r"\bweights\.csv\b", "the keyed weights"),
    # what the panel has not may be set in the scene file of the folder, as the page says
    (r"\b(?:Contact|Examples|Handles|Loads|Material|Mesh|Model|Output|Solver|Time)/([A-Z][A-Za-z']*(?: [a-z]+)?)", r"\1 (not in this panel)"),
    (r"^exemplar: ", ""),
]


def in_artists_words(text, directory, shot):
    """`text` of a run in a directory, and its shot."""
    text = text.replace(f"{directory}/", "")

    def name_of(found):
        kind, number = found[1], int(found[2])
        names = {"worn": [name for name, _, _ in shot.worn], "pose": shot.poses, "region": shot.regions}[kind]
        what = {"worn": "", "pose": "shape key ", "region": "vertex group "}[kind]
        return f"{what}'{names[number - 1]}'" if number <= len(names) else found[0]
    text = re.sub(r"(?:\bgroups\.csv:)?\b(worn|pose|region)_(\d+)\b(?:\.obj|\.msh)?", name_of, text)
    bodies = ", ".join(f"'{part.name}'" for part in shot.parts)
    text = re.sub(r"\bbody\.(obj|msh)\b", lambda _: bodies, text)
    for key, word in WORDS:
        text = re.sub(key, word, text, flags=re.MULTILINE)
    return text
