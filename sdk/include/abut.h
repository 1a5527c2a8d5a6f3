/* A body of your own in a scene of abut, in C: fill an abut_body and hand what fills it to
 * abut_serve(). docs/SOLVER.md goes through it; C++ has abut.hpp, Fortran abut.f90.
 *
 * The order of calls, in a run:
 *
 *     make(keys, body, with)  once; keys are those below model.external of the scene
 *     kernel(...)             before contact: how the ports give way; by default found by trying
 *     then for every window, as often as the coordinator wants:
 *         save()              the state at the window's begin
 *         step(dt, force)     for every substep, the last of which ends on the window's end
 *           displacement(), velocity()                   after every one
 *         energy(), momentum(), speed_bound()            at the ends of records
 *         restore()           the same window comes again with other forces, many times
 *     field(...)              where the scene has output.fields
 *
 * What step() does must follow from the state and the arguments alone: a window that is repeated
 * with the same forces ends in the same bits.
 *
 * Motions and forces are arrays of the ports' points in the order in which ports were named, each
 * (points, dim), row by row: x y x y ... in the plane. All units are SI.
 */
#ifndef ABUT_H
#define ABUT_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abut_keys abut_keys;   /* below model.external, read with file and line */
typedef struct abut_parts abut_parts; /* what the functions below tell of a body */

/* [J], of the whole body, in the form that its scheme conserves. */
typedef struct abut_energy {
  double kinetic, stored, dissipated;
  double external_work; /* done by loads and supports that the scene knows nothing of */
} abut_energy;

/* Beside mass and step all may be left as it comes. What is null, or answers nothing (its first
 * number stays as it comes, NaN), follows as is said. */
typedef struct abut_body {
  abut_parts *parts; /* is there already: leave it */
  void *self;        /* yours: what all functions are handed */
  const char *model; /* one line for people */
  int dim;           /* of space: 1, 2 or 3; comes as 1 */
  int conserves;     /* its energy changes by forces on ports and external work alone */
  int linear;        /* it answers forces linearly */
  int quasi_static;  /* it has no inertia: forces and springs balance after every step */
  double mass;       /* [kg], per metre in the plane; infinity: nothing moves it. To be given */
  double substep;      /* [s] wanted length of a step; 0: one step takes a record's time */
  double stable_step;  /* [s] limit of the step; comes as infinity: none */
  double surface_mass; /* [kg] least mass that moves with a point of a port; bounds its speed */

  /* Advances the state by dt [s] under a force on the points [N], which is constant meanwhile; of a
   * quasi-static body it is the force at the step's end. Null, or why the step could not be made:
   * the scene's policy decides, as with bodies of abut. */
  const char *(*step)(void *self, double dt, const double *force);
  /* [m] from the reference configuration. By default the state `u`. */
  void (*displacement)(void *self, double *u);
  /* [m/s]. By default the state `v`; of a quasi-static body way over time of a step. */
  void (*velocity)(void *self, double *v);
  /* [J] that came through each port in the last step. By default force times way. */
  void (*work)(void *self, double *joules);
  /* By default of one mass that moves as its first port does; momentum [kg m/s] (dim). */
  void (*energy)(void *self, abut_energy *energy);
  void (*momentum)(void *self, double *momentum);
  /* [m/s] how fast a point of a port may come, from now on, while nothing touches the body. By
   * default all energy in surface_mass; where that is not told it is infinity, and windows of free
   * flight are then taken one by one. acceleration_bound [m/s^2]: by which loads of the body's own
   * may raise that speed. */
  double (*speed_bound)(void *self);
  double (*acceleration_bound)(void *self);
  /* All that steps change, as numbers: how many, and into `to` unless that is null. restore: back
   * to them, exactly; it may be wanted again. By default what abut_state() has named. */
  size_t (*save)(void *self, double *to);
  void (*restore)(void *self, const double *from, size_t count);
  /* To the state from which kernels are found: by default where the body is at its begin. */
  void (*rest)(void *self);
  /* [m] (count, patterns, n, dim): what forces [N] (patterns, n, dim) over the first of `count`
   * steps of this length do to the port, at the end of each. Not 0: to be found by trying. */
  int (*kernel)(void *self, int port, int patterns, const double *force, double step, int count,
                double *displacement);
  /* Values of a field of abut_field(), by its number: (nodes or cells, components). */
  void (*field)(void *self, int field, double *values);
  void (*release)(void *self); /* at the end */
} abut_body;

/* Fills a body, once its keys have come. `with` is what abut_serve() was given. */
typedef void abut_make(abut_keys *keys, abut_body *body, void *with);

/* Runs this program as a body of a scene: `--connect ENDPOINT --body NAME`, as abut starts it.
 * Returns the program's exit code. */
int abut_serve(int argc, char **argv, abut_make *make, void *with);

/* ---- ports: one at least, named in make(); names are those of the scene, `face` if it is one */

/* In one dimension: a place [m] and the way it looks, 1.0 or -1.0. */
void abut_point(abut_body *body, const char *name, double position, double normal);
/* In two or three: points [m] (n, dim) and facets (m, corners) of them from 0; corners: 2 in the
 * plane, 3 or 4 in space; a triangle among quadrilaterals ends with -1. In the plane the body lies
 * to the left of who walks along a facet; in space the points of a facet turn counterclockwise for
 * who looks at the body from outside. */
void abut_surface(abut_body *body, const char *name, const double *points, int n, const int *facets,
                  int m, int corners);
/* Of the port named last: distance [m] of mesh nodes behind it, by default the mean edge of its
 * facets; time [s] in which the fastest wave crosses it, 0: rigid or unknown, as by default. */
void abut_resolution(abut_body *body, double spacing, double transit);

/* ---- state: numbers that steps change, at a place that stays */

void abut_state(abut_body *body, const char *name, double *values, size_t count);

/* ---- pictures: by default the surfaces of the ports with displacement and velocity */

/* What is drawn: points [m] (n, dim), and cells (m, nodes) of VTK's kind; a call for each. */
void abut_grid(abut_body *body, const double *points, int n);
void abut_cells(abut_body *body, int kind, const int *cells, int m, int nodes);
/* A field on its nodes, or on its cells; components: 1, 3 or 6. Numbered from 0. */
void abut_field(abut_body *body, const char *name, int on_cells, int components);

/* ---- keys: what is missing, impossible or not read is told with file, line and key, and the
 * program ends; until make() returns the values are those of `otherwise`, 1, NaN or "" */

int abut_has(const abut_keys *keys, const char *name);
double abut_number(abut_keys *keys, const char *name, const char *unit); /* unit "": none */
double abut_positive(abut_keys *keys, const char *name, const char *unit);
double abut_number_or(abut_keys *keys, const char *name, const char *unit, double otherwise);
int abut_count(abut_keys *keys, const char *name); /* a whole number above 0 */
const char *abut_text(abut_keys *keys, const char *name, const char *otherwise); /* null: needed */
int abut_length(const abut_keys *keys, const char *name); /* of a list; 0: it is none */
void abut_numbers(abut_keys *keys, const char *name, const char *unit, double *to, int count);
/* An error of yours: "is too heavy", "Give less than 5 kg.". */
void abut_refuse(abut_keys *keys, const char *name, const char *what, const char *remedy);
int abut_refused(const abut_keys *keys); /* whether anything was wrong so far */

#ifdef __cplusplus
}
#endif
#endif
