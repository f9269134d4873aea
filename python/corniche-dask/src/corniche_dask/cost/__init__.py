"""Estimates the cost of a build of another size, from measured builds."""

from .command import add_command, run

__all__ = ["add_command", "run"]
