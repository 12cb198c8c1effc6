"""The home service robot as a whole: launching, supervising and judging missions."""
