"""rtabmap's nodes, answered by what there is here."""
