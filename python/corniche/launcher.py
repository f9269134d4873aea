#!python
# The command `corniche` of a platform wheel: executes the program in the package, without importing
# the package, which would take longer.
import os
import sys
from importlib.util import find_spec

program = os.path.join(find_spec("corniche").submodule_search_locations[0], "released", "bin", "corniche")
os.execv(program, [program, *sys.argv[1:]])
