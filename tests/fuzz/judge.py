"""What became of an input: accepted, refused as it should be, or something else."""

import shutil
import traceback
from pathlib import Path
from typing import Any

from tensegym.errors import LONGEST, TensegymError
from tests.fuzz.environment import CALLS, Environment
from tests.fuzz.readers import READERS

ALLOWED = (TensegymError, OSError)
PACKAGE = Path(__file__).parents[2]


class Foreign(AssertionError):
    """An exception that is none of the project's, or a message too long to be read; ``kind`` says what and where."""

    def __init__(self, kind: str, error: BaseException) -> None:
        super().__init__(f"{kind}: {str(error)[:120]!r}")
        self.kind = kind


def trial(name: str, folder: Path):
    """A strategy of inputs and a function that judges one: True if accepted, False if refused, Foreign raised."""
    if name == "environment":
        environment = Environment()

        def play(call: Any) -> bool:
            try:
                return judged(environment.call, call)
            except Foreign:
                environment.close()
                raise

        return CALLS, play
    reader = READERS[name]
    for neighbour in reader.neighbours:
        shutil.copy(neighbour, folder)
    path = folder / f"input{reader.suffix}"

    def read(content: bytes) -> bool:
        path.write_bytes(content)
        return judged(reader.read, path)

    return reader.inputs(), read


def judged(function: Any, argument: Any) -> bool:
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


NAMES = (*READERS, "environment")
