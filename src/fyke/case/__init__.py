"""What the user wrote: the case file, read, checked and put into SI units."""
