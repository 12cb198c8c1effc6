"""The page, served by viser; no other package imports viser."""
