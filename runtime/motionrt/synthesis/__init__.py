"""Say it, and combine it: text to motion, body parts of action text, composition of motions."""
