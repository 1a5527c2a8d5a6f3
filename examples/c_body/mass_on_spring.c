/* A mass on a spring as a body of abut, in C.
 * usage: mass_on_spring --connect ENDPOINT --body NAME      (README.md beside this file) */
#include <abut.h>
#include <math.h>

typedef struct {
  double mass, stiffness, omega; /* [kg] [N/m] [1/s] */
  double u, v;                   /* [m] [m/s] */
} Mass;

/* Turns on its spring, exactly, about where the force of a substep holds it. */
static const char *step(void *self, double dt, const double *force) {
  Mass *m = self;
  const double rest = force[0] / m->stiffness, away = m->u - rest;
  const double c = cos(m->omega * dt), s = sin(m->omega * dt);
  m->u = rest + c * away + s * m->v / m->omega;
  m->v = c * m->v - s * m->omega * away;
  return NULL;
}

static void energy(void *self, abut_energy *energy) {
  const Mass *m = self;
  energy->kinetic = 0.5 * m->mass * m->v * m->v;
  energy->stored = 0.5 * m->stiffness * m->u * m->u;
}

static double speed_bound(void *self) {
  const Mass *m = self;
  return hypot(m->v, m->omega * m->u);
}

static void make(abut_keys *keys, abut_body *body, void *with) {
  Mass *m = with;
  m->mass = abut_positive(keys, "mass", "kg");
  m->stiffness = abut_positive(keys, "stiffness", "N/m");
  m->omega = sqrt(m->stiffness / m->mass);
  body->self = m;
  body->model = "mass on a spring, in C";
  body->mass = m->mass;
  body->substep = abut_positive(keys, "step", "s");
  body->conserves = body->linear = 1;
  body->step = step;
  body->energy = energy;
  body->speed_bound = speed_bound;
  abut_point(body, "face", abut_number(keys, "position", "m"), -1.0);
  abut_state(body, "u", &m->u, 1);
  abut_state(body, "v", &m->v, 1);
}

int main(int argc, char **argv) {
  Mass mass = {0};
  return abut_serve(argc, argv, make, &mass);
}
