! abut.h for Fortran: compile this file with your own, as modules are those of one compiler. What
! the members and functions mean stands in abut.h; arrays (dim, points) lie here as C has them
! (points, dim). Points of facets count from 0.
module abut
  use, intrinsic :: iso_c_binding
  implicit none
  public

  type, bind(c) :: abut_energy
    real(c_double) :: kinetic, stored, dissipated, external_work
  end type

  type, bind(c) :: abut_body
    type(c_ptr) :: parts, self, model
    integer(c_int) :: dim, conserves, linear, quasi_static
    real(c_double) :: mass, substep, stable_step, surface_mass
    type(c_funptr) :: step, displacement, velocity, work, energy, momentum
    type(c_funptr) :: speed_bound, acceleration_bound, save, restore, rest, kernel, field, release
  end type

  abstract interface
    subroutine abut_make(keys, body, with) bind(c)
      import :: c_ptr, abut_body
      type(c_ptr), value :: keys, with
      type(abut_body), intent(inout) :: body
    end subroutine
  end interface

  interface
    function abut_serve(argc, argv, make, with) result(code) bind(c)
      import :: c_int, c_ptr, c_funptr
      integer(c_int), value :: argc
      type(c_ptr), intent(in) :: argv(*)
      type(c_funptr), value :: make
      type(c_ptr), value :: with
      integer(c_int) :: code
    end function
    subroutine abut_point(body, name, position, normal) bind(c)
      import :: abut_body, c_char, c_double
      type(abut_body), intent(inout) :: body
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), value :: position, normal
    end subroutine
    subroutine abut_surface(body, name, points, n, facets, m, corners) bind(c)
      import :: abut_body, c_char, c_double, c_int
      type(abut_body), intent(inout) :: body
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: points(*)
      integer(c_int), intent(in) :: facets(*)
      integer(c_int), value :: n, m, corners
    end subroutine
    subroutine abut_resolution(body, spacing, transit) bind(c)
      import :: abut_body, c_double
      type(abut_body), intent(inout) :: body
      real(c_double), value :: spacing, transit
    end subroutine
    subroutine abut_state(body, name, values, count) bind(c)
      import :: abut_body, c_char, c_double, c_size_t
      type(abut_body), intent(inout) :: body
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in), target :: values(*)
      integer(c_size_t), value :: count
    end subroutine
    subroutine abut_grid(body, points, n) bind(c)
      import :: abut_body, c_double, c_int
      type(abut_body), intent(inout) :: body
      real(c_double), intent(in) :: points(*)
      integer(c_int), value :: n
    end subroutine
    subroutine abut_cells(body, kind, cells, m, nodes) bind(c)
      import :: abut_body, c_int
      type(abut_body), intent(inout) :: body
      integer(c_int), value :: kind, m, nodes
      integer(c_int), intent(in) :: cells(*)
    end subroutine
    subroutine abut_field(body, name, on_cells, components) bind(c)
      import :: abut_body, c_char, c_int
      type(abut_body), intent(inout) :: body
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int), value :: on_cells, components
    end subroutine
    function abut_has(keys, name) result(there) bind(c)
      import :: c_ptr, c_char, c_int
      type(c_ptr), value :: keys
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int) :: there
    end function
    function abut_number(keys, name, unit) result(value) bind(c)
      import :: c_ptr, c_char, c_double
      type(c_ptr), value :: keys
      character(kind=c_char), intent(in) :: name(*), unit(*)
      real(c_double) :: value
    end function
    function abut_positive(keys, name, unit) result(value) bind(c)
      import :: c_ptr, c_char, c_double
      type(c_ptr), value :: keys
      character(kind=c_char), intent(in) :: name(*), unit(*)
      real(c_double) :: value
    end function
    function abut_count(keys, name) result(value) bind(c)
      import :: c_ptr, c_char, c_int
      type(c_ptr), value :: keys
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int) :: value
    end function
    subroutine abut_numbers(keys, name, unit, to, count) bind(c)
      import :: c_ptr, c_char, c_double, c_int
      type(c_ptr), value :: keys
      character(kind=c_char), intent(in) :: name(*), unit(*)
      real(c_double), intent(out) :: to(*)
      integer(c_int), value :: count
    end subroutine
    subroutine abut_refuse(keys, name, what, remedy) bind(c)
      import :: c_ptr, c_char
      type(c_ptr), value :: keys
      character(kind=c_char), intent(in) :: name(*), what(*), remedy(*)
    end subroutine
    function abut_refused(keys) result(refused) bind(c)
      import :: c_ptr, c_int
      type(c_ptr), value :: keys
      integer(c_int) :: refused
    end function
  end interface

contains

  ! As C has it: with the 0 at its end.
  pure function c(text)
    character(len=*), intent(in) :: text
    character(len=len(text) + 1, kind=c_char) :: c
    c = text // c_null_char
  end function

  ! Runs this program as a body of a scene and ends it. make fills the body when its keys have come.
  subroutine serve(make)
    procedure(abut_make) :: make
    integer, parameter :: longest = 4096
    character(len=longest, kind=c_char), allocatable, target :: words(:)
    type(c_ptr), allocatable :: argv(:)
    character(len=longest - 1) :: word
    integer :: i, n
    n = command_argument_count() + 1
    allocate(words(n), argv(n))
    do i = 1, n
      call get_command_argument(i - 1, word)
      words(i) = trim(word) // c_null_char
      argv(i) = c_loc(words(i))
    end do
    call exit(abut_serve(int(n, c_int), argv, c_funloc(make), c_null_ptr))
  end subroutine
end module
