"""Replays: what a robot did, recorded while it did it, kept in one file that any browser plays, and drawn.

`recording.py` is the data, `recorder.py` makes it while an episode runs, `replay_file.py` writes and reads the file,
`page/` is the page that
plays it, `scenery.py` what the page draws.
"""

from .recorder import Recorder
from .recording import Recording
from .replay_file import read_replay, write_replay

__all__ = ["Recorder", "Recording", "read_replay", "write_replay"]
