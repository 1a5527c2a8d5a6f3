/* A mass on a spring as an FMU of FMI 3.0, for co-simulation: what a body of abut needs of one.
 * make_fmu.py beside this file compiles and packs it. Declarations are those of the standard. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef enum { ok, warning, discard, error, fatal } Status;
typedef uint32_t Reference;

enum { TIME, MASS, STIFFNESS, FORCE, U, V, KINETIC, STORED, MOMENTUM, COUNT };

typedef struct {
  double value[COUNT];
} Model;

static void derive(Model* m) {
  double* x = m->value;
  x[KINETIC] = 0.5 * x[MASS] * x[V] * x[V];
  x[STORED] = 0.5 * x[STIFFNESS] * x[U] * x[U];
  x[MOMENTUM] = x[MASS] * x[V];
}

const char* fmi3GetVersion(void) { return "3.0"; }

void* fmi3InstantiateCoSimulation(const char* name, const char* token, const char* resources,
                                  bool visible, bool logging, bool events, bool early,
                                  const Reference wanted[], size_t count, void* environment,
                                  void (*log)(void*, Status, const char*, const char*),
                                  void (*update)(void)) {
  (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early;
  (void)wanted, (void)count, (void)update;
  if (strcmp(token, "{abut-mass-on-spring}") != 0) {
    log(environment, error, "logStatusError", "the token is that of another FMU");
    return NULL;
  }
  Model* m = calloc(1, sizeof(Model));
  if (m != NULL) m->value[MASS] = m->value[STIFFNESS] = 1.0;
  return m;
}
void fmi3FreeInstance(void* m) { free(m); }

Status fmi3EnterInitializationMode(void* m, bool has_tolerance, double tolerance, double begin,
                                   bool has_end, double end) {
  (void)has_tolerance, (void)tolerance, (void)has_end, (void)end;
  ((Model*)m)->value[TIME] = begin;
  return ok;
}
Status fmi3ExitInitializationMode(void* m) {
  derive(m);
  return ok;
}
Status fmi3Terminate(void* m) { return m != NULL ? ok : error; }

Status fmi3SetFloat64(void* m, const Reference which[], size_t n, const double values[], size_t k) {
  if (n != k) return error;
  for (size_t i = 0; i < n; ++i) {
    if (which[i] < MASS || which[i] > V) return error;
    ((Model*)m)->value[which[i]] = values[i];
  }
  return ok;
}
Status fmi3GetFloat64(void* m, const Reference which[], size_t n, double values[], size_t k) {
  if (n != k) return error;
  for (size_t i = 0; i < n; ++i) {
    if (which[i] >= COUNT) return error;
    values[i] = ((Model*)m)->value[which[i]];
  }
  return ok;
}

/* It turns on its spring, exactly, about where the force holds it. */
Status fmi3DoStep(void* me, double time, double dt, bool forward_only, bool* event, bool* ends,
                  bool* early, double* last) {
  double* x = ((Model*)me)->value;
  (void)forward_only;
  if (fabs(time - x[TIME]) > 1e-9 * dt) return error;
  const double omega = sqrt(x[STIFFNESS] / x[MASS]), rest = x[FORCE] / x[STIFFNESS];
  const double c = cos(omega * dt), s = sin(omega * dt), away = x[U] - rest, v = x[V];
  x[U] = rest + c * away + s * v / omega;
  x[V] = c * v - s * omega * away;
  x[TIME] = time + dt;
  derive(me);
  *event = *ends = *early = false;
  *last = x[TIME];
  return ok;
}

Status fmi3GetFMUState(void* m, void** state) {
  if (*state == NULL) *state = malloc(sizeof(Model));
  if (*state == NULL) return error;
  memcpy(*state, m, sizeof(Model));
  return ok;
}
Status fmi3SetFMUState(void* m, void* state) {
  memcpy(m, state, sizeof(Model));
  return ok;
}
Status fmi3FreeFMUState(void* m, void** state) {
  (void)m;
  free(*state);
  *state = NULL;
  return ok;
}
Status fmi3SerializedFMUStateSize(void* m, void* state, size_t* size) {
  (void)m, (void)state;
  *size = sizeof(Model);
  return ok;
}
Status fmi3SerializeFMUState(void* m, void* state, uint8_t to[], size_t size) {
  (void)m;
  if (size != sizeof(Model)) return error;
  memcpy(to, state, size);
  return ok;
}
Status fmi3DeserializeFMUState(void* m, const uint8_t from[], size_t size, void** state) {
  if (size != sizeof(Model)) return error;
  if (fmi3GetFMUState(m, state) != ok) return error;
  memcpy(*state, from, size);
  return ok;
}
