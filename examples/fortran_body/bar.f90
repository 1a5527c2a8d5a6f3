! A bar in one dimension as a body of abut, in Fortran.
! usage: bar --connect ENDPOINT --body NAME      (README.md beside this file)
module bar_body
  use abut
  implicit none
  real(c_double), allocatable, target :: u(:), v(:), masses(:)  ! [m] [m/s] [kg] of the nodes
  real(c_double) :: stiffness, half_step                        ! [N/m] of an element, [s]
  character(len=*), parameter :: name = "bar of linear elements, in Fortran" // c_null_char
  character(len=len(name), kind=c_char), target :: model = name

contains

  subroutine make(keys, body, with) bind(c)
    type(c_ptr), value :: keys, with
    type(abut_body), intent(inout) :: body
    real(c_double) :: length, area, density, velocity
    integer :: elements
    length = abut_positive(keys, c("length"), c("m"))
    area = abut_positive(keys, c("area"), c("m^2"))
    density = abut_positive(keys, c("density"), c("kg/m^3"))
    elements = abut_count(keys, c("elements"))
    velocity = abut_number(keys, c("velocity"), c("m/s"))
    stiffness = abut_positive(keys, c("youngs_modulus"), c("Pa")) * area * elements / length
    allocate(u(elements + 1), v(elements + 1), masses(elements + 1))
    masses = density * area * length / elements
    masses([1, elements + 1]) = masses([1, elements + 1]) / 2
    u = 0
    v = velocity

    body%model = c_loc(model)
    body%mass = sum(masses)
    body%substep = abut_positive(keys, c("step"), c("s"))
    body%conserves = 1
    body%linear = 1
    half_step = body%substep / 2
    body%step = c_funloc(step)
    body%displacement = c_funloc(displacement)
    body%velocity = c_funloc(speed)
    body%energy = c_funloc(energy)
    body%momentum = c_funloc(momentum)
    call abut_point(body, c("tip"), abut_number(keys, c("position"), c("m")), -1.0_c_double)
    call abut_resolution(body, length / elements, length / elements * sqrt(density * area / &
      (stiffness * length / elements)))
    call abut_state(body, c("u of all nodes"), u, size(u, kind=c_size_t))
    call abut_state(body, c("v of all nodes"), v, size(v, kind=c_size_t))
  end subroutine

  ! [N] of the elements, against displacements.
  function pulled() result(f)
    real(c_double) :: f(size(u)), tension(size(u) - 1)
    tension = stiffness * (u(2:) - u(:size(u) - 1))
    f = 0
    f(:size(u) - 1) = -tension
    f(2:) = f(2:) + tension
  end function

  ! Central difference.
  function step(self, dt, force) result(why) bind(c)
    type(c_ptr), value :: self
    real(c_double), value :: dt
    real(c_double), intent(in) :: force(*)
    type(c_ptr) :: why
    call kick(dt / 2, force(1))
    u = u + dt * v
    call kick(dt / 2, force(1))
    why = c_null_ptr
  end function

  subroutine kick(dt, force)
    real(c_double), intent(in) :: dt, force
    real(c_double) :: f(size(u))
    f = -pulled()
    f(1) = f(1) + force
    v = v + dt * f / masses
  end subroutine

  subroutine displacement(self, to) bind(c)
    type(c_ptr), value :: self
    real(c_double), intent(out) :: to(*)
    to(1) = u(1)
  end subroutine

  subroutine speed(self, to) bind(c)
    type(c_ptr), value :: self
    real(c_double), intent(out) :: to(*)
    to(1) = v(1)
  end subroutine

  ! What central differences conserve: velocities before and after a level, multiplied.
  subroutine energy(self, to) bind(c)
    type(c_ptr), value :: self
    type(abut_energy), intent(inout) :: to
    real(c_double) :: pull(size(u))
    pull = pulled()
    to%kinetic = 0.5 * sum(masses * (v**2 - (half_step * pull / masses)**2))
    to%stored = 0.5 * sum(u * pull)
  end subroutine

  subroutine momentum(self, to) bind(c)
    type(c_ptr), value :: self
    real(c_double), intent(out) :: to(*)
    to(1) = sum(masses * v)
  end subroutine
end module

program bar
  use bar_body
  implicit none
  call serve(make)
end program
