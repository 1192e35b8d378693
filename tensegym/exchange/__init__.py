"""Files of other tools: read into a design's table, written from a design. Units are asked for, never guessed.

ntrt.py, ntrt_parts.py, ntrt_builders.py: YAML models of the NASA Tensegrity Robotics Toolkit. matrices.py: nodes and
connectivity as CSV, as MOTES, TsgFEM and tnsgrt have them. written.py: both, from a design.
"""

from .matrices import read_matrices
from .ntrt import read_ntrt
from .table import UNITS, Imported
from .written import matrix_files, ntrt_text

__all__ = ["UNITS", "Imported", "matrix_files", "ntrt_text", "read_matrices", "read_ntrt"]
