# SPDX-License-Identifier: GPL-3.0-or-later
"""The page on which a problem's body is pulled. The module imports this file when problem.live() is called."""
import os
import shutil
import subprocess
import tempfile
import weakref
from pathlib import Path
from typing import Callable, Optional, Union

from exemplar import UserError

Record = Optional[Union[str, "os.PathLike[str]"]]  # directory in which the session is kept


def program() -> str:
    """Beside the module in a build, under the same prefix where it is installed, or in the PATH."""
    package = Path(__file__).resolve().parent
    places = [package.parents[1] / "exemplar-live", package.parents[3] / "bin/exemplar-live"]
    found = next((str(place) for place in places if place.is_file()), None) or shutil.which("exemplar-live")
    if found is None:
        raise UserError("live(): the program exemplar-live is neither under " + str(package.parents[3]) + " nor in the PATH. Install "
                        "the program exemplar, too (doc/installing.md).")
    return found


def end(process: "subprocess.Popen[str]", directory: "tempfile.TemporaryDirectory[str]") -> None:
    """The server ends when its input does."""
    assert process.stdin and process.stdout
    process.stdin.close()
    process.wait()
    process.stdout.close()
    directory.cleanup()


class Live:
    """A server of a page; a context."""

    def __init__(self, process: "subprocess.Popen[str]", directory: "tempfile.TemporaryDirectory[str]") -> None:
        self._log = Path(directory.name) / "log.txt"
        self._end = weakref.finalize(self, end, process, directory)
        line = ""
        assert process.stdout
        while not line.startswith("Open "):
            line = process.stdout.readline()
            if not line:
                process.wait()
                said = self.log
                self.close()
                raise UserError("live(): " + said.strip().removeprefix("exemplar: "))
        self.address = line.split()[1]

    @property
    def log(self) -> str:
        """What the server has said so far, such as whom it has refused."""
        return self._log.read_text(errors="replace") if self._log.exists() else ""

    def close(self) -> None:
        """End the server. The page then shows the last frame."""
        self._end()

    def __enter__(self) -> "Live":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<exemplar live: {self.address if self._end.alive else 'closed'}>"


def checked(port: object, record: Record) -> list[str]:
    """The arguments of the program."""
    if record is not None and not isinstance(record, (str, os.PathLike)):
        raise UserError(f"live(): record is {record!r}. Allowed: the path of a directory, or None.")
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
        raise UserError(f"live(): port is {port!r}. Allowed: whole numbers from 0, one that is free, to 65535.")
    return ["--port", str(port), *(["--record", os.fspath(record)] if record is not None else [])]


def directory_of_recording(record: "str | os.PathLike[str]") -> Path:
    """Made, and absolute; it is refused before anything is written if it holds what is no recording's."""
    directory = Path(record).absolute()
    try:
        directory.mkdir(parents=True, exist_ok=True)
        if not (directory / "session.txt").exists() and any(file.suffix != ".msh" for file in directory.iterdir()):
            raise UserError(f"live(): record={record} is neither an empty directory nor one of a recording. Give another one.")
    except OSError as error:
        raise UserError(f"live(): record={record} is no directory that can be written: {error.strerror}. Give another one.") from error
    return directory


def live(write: Callable[[str, str], None], port: object, record: Record) -> Live:
    """write(file, directory) writes the scene, and into a directory that is kept with the session what stands for arrays."""
    arguments = checked(port, record)
    server = program()
    directory = tempfile.TemporaryDirectory(prefix="exemplar-live-")
    try:
        kept = Path(directory.name) if record is None else directory_of_recording(record)
        scene = Path(directory.name) / "scene.prm"
        write(str(scene), str(kept))
        with open(Path(directory.name) / "log.txt", "wb") as log:
            process = subprocess.Popen([server, "live", str(scene), "--until-input-ends", *arguments], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, stderr=log, text=True, start_new_session=True)
    except BaseException:
        directory.cleanup()
        raise
    page = Live(process, directory)
    print("Open", page.address, flush=True)
    return page
