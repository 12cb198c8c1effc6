"""Beyond amcl: detection of a lost robot, and pose hypotheses for it."""
