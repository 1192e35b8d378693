"""What became of an input: accepted, refused as it should be, or something else."""

import shutil
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hypothesis.strategies import SearchStrategy

from tensegym.errors import LONGEST, TensegymError
from tests.fuzz.called import CALLED
from tests.fuzz.readers import READERS

ALLOWED = (TensegymError, OSError)
PACKAGE = Path(__file__).parents[2]


class Foreign(AssertionError):
    """An exception that is none of the project's, or a message too long to be read; ``kind`` says what and where."""

    def __init__(self, kind: str, error: BaseException) -> None:
        super().__init__(f"{kind}: {str(error)[:120]!r}")
        self.kind = kind


def trial(name: str, folder: Path) -> tuple[SearchStrategy[Any], Callable[[Any], bool]]:
    """A strategy of inputs and a function that judges one: True if accepted, False if refused, Foreign raised."""
    if name in CALLED:
        inputs, call, forget = CALLED[name](folder)

        def play(given: Any) -> bool:
            try:
                return judged(call, given, folder)
            except Foreign:
                forget()
                raise

        return inputs, play
    reader = READERS[name]
    for neighbour in reader.neighbours:
        shutil.copy(neighbour, folder)
    for beside, content in (reader.beside() if reader.beside else {}).items():
        (folder / beside).write_bytes(content)
    path = folder / reader.file

    def read(content: bytes) -> bool:
        path.write_bytes(content)
        return judged(reader.read, path, folder)

    return reader.inputs(), read


def judged(function: Any, argument: Any, folder: Path) -> bool:
    """Whether it was accepted; nothing half written may be left in the folder either way."""
    try:
        return _accepted(function, argument)
    finally:
        half = [path for path in folder.rglob(".tensegym-*") if path.name != ".tensegym-lock"]
        for path in half:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        if half:
            raise Foreign(f"{half[0].name.split('-')[-1]} half written", AssertionError(str(half[0])))


def _accepted(function: Any, argument: Any) -> bool:
    try:
        function(argument)
    except ALLOWED as error:
        if len(str(error)) > LONGEST:
            raise Foreign(f"a long message from {where(error)}", error) from error
        return False
    except (Exception, RecursionError) as error:
        raise Foreign(f"{type(error).__name__} at {where(error)}", error) from error
    return True


def where(error: BaseException) -> str:
    """The last line of the package that the error passed."""
    own = [f for f in traceback.extract_tb(error.__traceback__)
           if f.filename.startswith(str(PACKAGE)) and "/tests/" not in f.filename]  # fmt: skip
    last = own[-1] if own else traceback.extract_tb(error.__traceback__)[-1]
    return f"{Path(last.filename).relative_to(PACKAGE) if own else last.filename}:{last.lineno}"


NAMES = (*READERS, *CALLED)
