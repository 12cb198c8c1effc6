"""The plan of a home: walls with openings, furniture, rooms, places and zones."""
