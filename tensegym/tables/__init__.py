"""The one reader of tables: files parsed, fields typed and ranged, each fault one clear line of the caller's error.

A dataclass says what a table may hold: its fields are made by `bounded`, `choice`, `noted` or `parsed`, and their types
are read from the annotations. `fill` makes it out of a table, `describe` lists its fields.
"""

from .fields import Checked, FieldRow, bounded, check_fields, choice, describe, fill, noted, parsed, read_fields
from .ranges import Range
from .records import read_records
from .rows import Rows, number_of, read_rows
from .text import decode, parse_json, parse_toml, parse_yaml, read_json, read_text, read_toml, read_yaml
from .values import (
    Error,
    as_number,
    as_numbers,
    as_rows,
    as_text,
    as_whole,
    as_whole_rows,
    hint,
    in_file,
    known,
    mapping,
    one_line,
    show,
)

__all__ = [
    "Checked", "Error", "FieldRow", "Range", "Rows", "as_number", "as_numbers", "as_rows", "as_text",
    "as_whole", "as_whole_rows", "bounded", "check_fields", "choice", "decode", "describe", "fill", "hint",
    "in_file", "known", "mapping", "noted", "number_of", "one_line", "parse_json", "parse_toml", "parse_yaml", "parsed",
    "read_fields", "read_json", "read_records", "read_rows", "read_text", "read_toml", "read_yaml", "show",
]  # fmt: skip
