"""``python -m corniche …``: the program itself."""

import os
import sys

from .errors import ProgramError
from .program import find_program

try:
    program = find_program()
except ProgramError as error:
    sys.exit(f"corniche: {error}")
os.execv(program, [program, *sys.argv[1:]])
