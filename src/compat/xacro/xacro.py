#!/usr/bin/env python3
import sys

# This folder, in which this very file would pass for the library.
del sys.path[0]

from xacro import main  # noqa: E402

main()
