"""A robot with a microcontroller board at the end of a serial link."""
