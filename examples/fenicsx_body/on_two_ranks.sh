#!/bin/sh
# fenicsx_solid.py on two ranks of MPI, as a program that scenes can start (README.md beside this).
exec mpirun -n 2 --oversubscribe --bind-to none \
  /usr/bin/python3 "$(dirname "$0")/fenicsx_solid.py" "$@"
