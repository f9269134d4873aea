"""What a build of another size would cost, from builds that were measured."""

from .command import add_command, run

__all__ = ["add_command", "run"]
