"""Runs the program on scenes with a known outcome and judges what it wrote."""
