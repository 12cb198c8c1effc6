"""Course projects without a script: how they are launched, and how they are checked."""
