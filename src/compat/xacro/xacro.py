#!/usr/bin/env python3
import sys

# This folder, in which this very file would pass for the library.
del sys.path[0]

from xacro import main  # noqa: E402

# Kinetic's default order, which later ones do not have.
sys.argv = [word for word in sys.argv if word != "--oldorder"]
main()
