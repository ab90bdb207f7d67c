# SPDX-License-Identifier: GPL-3.0-or-later
"""What pip calls to build the Python module (PEP 517): CMake and Ninja make the module alone, in build/pip, and the files of its
installation become a wheel. EXEMPLAR_BUILD=build/release takes the module from a build that is there, and compiles nothing.
"""
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

from wheel.wheelfile import WheelFile

TOP = Path(__file__).resolve().parents[2]
VERSION = re.search(r"^project\(exemplar VERSION ([\d.]+)", (TOP / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
INFO = f"exemplar-{VERSION}.dist-info"
METADATA = f"""Metadata-Version: 2.1
Name: exemplar
Version: {VERSION}
Summary: Elastic solids that deform the way their examples say
License: GPL-3.0-or-later
Requires-Python: >={sys.version_info.major}.{sys.version_info.minor}
Requires-Dist: numpy
Provides-Extra: plot
Requires-Dist: matplotlib; extra == "plot"
"""


def run(*command):
    try:
        subprocess.run(command, cwd=TOP, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"The module could not be built: {error}\nIt needs CMake, Ninja, deal.II, pybind11, numpy and Python's headers: on "
                 "Debian, ./demo.sh --install-only installs them. doc/installing.md lists them for other systems.")


def build():
    """The directory of a build of the module for this interpreter."""
    given = os.environ.get("EXEMPLAR_BUILD")
    if given:
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        if not Path(TOP, given, "python/exemplar/__init__" + suffix).exists():
            sys.exit(f"EXEMPLAR_BUILD={given} holds no python/exemplar/__init__{suffix}. Build the target exemplar_python there, "
                     "with this interpreter, or unset EXEMPLAR_BUILD.")
        return Path(TOP, given)
    directory = TOP / "build/pip"
    run("cmake", "-S", TOP, "-B", directory, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF", "-DEXEMPLAR_PYTHON=ON",
        f"-DPython3_EXECUTABLE={sys.executable}")
    run("cmake", "--build", directory, "--target", "exemplar_python")
    return directory


def write_info(directory, tag):
    """The dist-info of the wheel, but its RECORD."""
    info = Path(directory, INFO)
    info.mkdir()
    (info / "METADATA").write_text(METADATA)
    (info / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: exemplar\nRoot-Is-Purelib: false\nTag: {tag}\n")
    shutil.copy(TOP / "LICENSE", info)


def wheel_tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    write_info(metadata_directory, wheel_tag())
    return INFO


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name = f"exemplar-{VERSION}-{wheel_tag()}.whl"
    with tempfile.TemporaryDirectory() as directory:
        run("cmake", "--install", build(), "--component", "python", "--strip", "--prefix", directory)
        packages = Path(directory, "lib/python3/dist-packages")
        write_info(packages, wheel_tag())
        with WheelFile(Path(wheel_directory, name), "w") as wheel:
            wheel.write_files(packages)
    return name


def build_sdist(sdist_directory, config_settings=None):
    name = f"exemplar-{VERSION}.tar.gz"
    run("git", "archive", f"--prefix=exemplar-{VERSION}/", "-o", Path(sdist_directory, name), "HEAD")
    return name
