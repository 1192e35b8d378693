"""The commands of `tensegym` that need no learning library: one dataclass a command, one a file."""
