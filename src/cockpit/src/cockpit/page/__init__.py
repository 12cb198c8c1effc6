"""The page, by viser: the one room that knows it."""
