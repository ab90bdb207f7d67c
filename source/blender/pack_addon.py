# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the add-on as Blender installs it.

Usage: python3 pack_addon.py exemplar_addon.zip
"""
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main(target):
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(set(HERE.glob("*.py")) - {Path(__file__).resolve()}):
            archive.writestr(zipfile.ZipInfo(f"exemplar_addon/{file.name}"), file.read_bytes())


if __name__ == "__main__":
    main(sys.argv[1])
