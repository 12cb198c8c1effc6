"""Analysis of a checkout: its layout, its missing packages, and the paths that its files expect."""
