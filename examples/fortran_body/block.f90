! A block in the plane as a body of abut, in Fortran.
! usage: block --connect ENDPOINT --body NAME      (README.md beside this file)
module block_body
  use abut
  implicit none
  integer :: nx, ny
  integer, allocatable :: cells(:, :)                          ! (4, cells) nodes, counterclockwise
  integer, allocatable :: face(:)                              ! nodes that may touch others
  real(c_double), allocatable :: points(:, :), masses(:)       ! [m] (2, nodes), [kg/m] (nodes)
  real(c_double), allocatable, target :: u(:, :), v(:, :)      ! [m] [m/s] (2, nodes)
  real(c_double) :: cell(8, 8), half_step                      ! [N/m^2] of a cell, [s]
  character(len=*), parameter :: name = "block of four-node cells, in Fortran" // c_null_char
  character(len=len(name), kind=c_char), target :: model = name

contains

  subroutine make(keys, body, with) bind(c)
    type(c_ptr), value :: keys, with
    type(abut_body), intent(inout) :: body
    real(c_double) :: lengths(2), corner(2), velocity(2), modulus, ratio, density
    integer :: i
    nx = abut_count(keys, c("cells_along"))
    ny = abut_count(keys, c("cells_across"))
    call abut_numbers(keys, c("lengths"), c("m"), lengths, 2)
    call abut_numbers(keys, c("corner"), c("m"), corner, 2)
    call abut_numbers(keys, c("velocity"), c("m/s"), velocity, 2)
    modulus = abut_positive(keys, c("youngs_modulus"), c("Pa"))
    ratio = abut_number(keys, c("poissons_ratio"), c(""))
    density = abut_positive(keys, c("density"), c("kg/m^3"))
    call make_mesh(corner, lengths)
    call make_cell(lengths / [nx, ny], modulus, ratio)
    allocate(masses(size(points, 2)), u(2, size(points, 2)), v(2, size(points, 2)))
    masses = 0
    do i = 1, size(cells, 2)
      masses(cells(:, i)) = masses(cells(:, i)) + density * product(lengths) / (4 * nx * ny)
    end do
    u = 0
    v = spread(velocity, 2, size(points, 2))

    body%dim = 2
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
    call abut_surface(body, c("face"), points(:, face), size(face), &
      [(i, i + 1, i = 0, size(face) - 2)], size(face) - 1, 2)
    call abut_state(body, c("u of all nodes"), u, size(u, kind=c_size_t))
    call abut_state(body, c("v of all nodes"), v, size(v, kind=c_size_t))
  end subroutine

  ! The face is the left side, from above down: the body lies to the left.
  subroutine make_mesh(corner, lengths)
    real(c_double), intent(in) :: corner(2), lengths(2)
    integer :: i, j, first
    allocate(points(2, (nx + 1) * (ny + 1)), cells(4, nx * ny))
    do i = 0, nx
      do j = 0, ny
        first = i * (ny + 1) + j + 1
        points(:, first) = corner + lengths * [real(c_double) :: i, j] / [nx, ny]
        if (i == nx .or. j == ny) cycle
        cells(:, i * ny + j + 1) = [first, first + ny + 1, first + ny + 2, first + 1]
      end do
    end do
    face = [(j, j = ny + 1, 1, -1)]
  end subroutine

  ! Stiffness of a cell: strains at four points, by the law of plane strain.
  subroutine make_cell(size_of, modulus, ratio)
    real(c_double), intent(in) :: size_of(2), modulus, ratio
    real(c_double), parameter :: sx(4) = [-1, 1, 1, -1], sy(4) = [-1, -1, 1, 1]
    real(c_double) :: law(3, 3), strain(3, 8), lame, shear, gauss
    integer :: k
    lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
    shear = modulus / (2 * (1 + ratio))
    gauss = 1 / sqrt(3.0_c_double)
    law = reshape([lame + 2 * shear, lame, 0.0_c_double, lame, lame + 2 * shear, 0.0_c_double, &
      0.0_c_double, 0.0_c_double, shear], [3, 3])
    cell = 0
    do k = 1, 4
      strain = 0
      strain(1, 1::2) = sx * (1 + gauss * sy(k) * sy) / (2 * size_of(1))
      strain(2, 2::2) = sy * (1 + gauss * sx(k) * sx) / (2 * size_of(2))
      strain(3, 1::2) = strain(2, 2::2)
      strain(3, 2::2) = strain(1, 1::2)
      cell = cell + matmul(transpose(strain), matmul(law, strain)) * product(size_of) / 4
    end do
  end subroutine

  ! [N/m] of the cells, against displacements.
  function pulled() result(f)
    real(c_double) :: f(2, size(u, 2))
    integer :: i
    f = 0
    do i = 1, size(cells, 2)
      f(:, cells(:, i)) = f(:, cells(:, i)) + &
        reshape(matmul(cell, reshape(u(:, cells(:, i)), [8])), [2, 4])
    end do
  end function

  ! Central difference.
  function step(self, dt, force) result(why) bind(c)
    type(c_ptr), value :: self
    real(c_double), value :: dt
    real(c_double), intent(in) :: force(2, *)
    type(c_ptr) :: why
    call kick(dt / 2, force(:, :size(face)))
    u = u + dt * v
    call kick(dt / 2, force(:, :size(face)))
    why = c_null_ptr
  end function

  subroutine kick(dt, force)
    real(c_double), intent(in) :: dt, force(:, :)
    real(c_double) :: f(2, size(u, 2))
    f = -pulled()
    f(:, face) = f(:, face) + force
    v = v + dt * f / spread(masses, 1, 2)
  end subroutine

  subroutine displacement(self, to) bind(c)
    type(c_ptr), value :: self
    real(c_double), intent(out) :: to(2, *)
    to(:, :size(face)) = u(:, face)
  end subroutine

  subroutine speed(self, to) bind(c)
    type(c_ptr), value :: self
    real(c_double), intent(out) :: to(2, *)
    to(:, :size(face)) = v(:, face)
  end subroutine

  ! What central differences conserve: velocities before and after a level, multiplied.
  subroutine energy(self, to) bind(c)
    type(c_ptr), value :: self
    type(abut_energy), intent(inout) :: to
    real(c_double) :: pull(2, size(u, 2)), m(2, size(u, 2))
    pull = pulled()
    m = spread(masses, 1, 2)
    to%kinetic = 0.5 * sum(m * (v**2 - (half_step * pull / m)**2))
    to%stored = 0.5 * sum(u * pull)
  end subroutine

  subroutine momentum(self, to) bind(c)
    type(c_ptr), value :: self
    real(c_double), intent(out) :: to(2)
    to = matmul(v, masses)
  end subroutine
end module

program block
  use block_body
  implicit none
  call serve(make)
end program
