"""What a world looks like: cuts, drawings, pictures, its true map."""
