#!/bin/sh
# abut-solver on two ranks of MPI, as a program that scenes can start (README.md beside this).
exec mpirun -n 2 --oversubscribe --bind-to none "${ABUT_SOLVER:-abut-solver}" "$@"
