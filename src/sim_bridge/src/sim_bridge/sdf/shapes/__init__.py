"""<geometry> and <material> elements as shapes and their colours."""
