! The C interface of Apsis for Fortran 2003: the functions, constants and callbacks of apsis.h, where they are described.
! Compile it with your program, and link libapsis_c. Texts of C end with c_null_char; apsis_string() converts them.
module apsis
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_f_pointer, c_funptr, c_int, c_long_long, c_null_char, c_ptr, &
                                         c_size_t, c_associated
  implicit none
  private :: c_char, c_double, c_f_pointer, c_funptr, c_int, c_long_long, c_null_char, c_ptr, c_size_t, c_associated

  integer(c_int), parameter :: APSIS_MODULE_ABI_VERSION = 1  ! APSIS_ABI_VERSION; Fortran reads that as the function

  ! apsis_status
  integer(c_int), parameter :: APSIS_OK = 0, APSIS_STOPPED = 1, APSIS_EVENT = 2, &
                               APSIS_INPUT_ERROR = -1, APSIS_NUMERICAL_ERROR = -2, APSIS_FILE_ERROR = -3, &
                               APSIS_CLAIM_ERROR = -4, APSIS_CALLBACK_ERROR = -5, APSIS_MEMORY_ERROR = -6, &
                               APSIS_INTERNAL_ERROR = -7
  ! apsis_needs
  integer(c_int), parameter :: APSIS_NEEDS_RATE = 1, APSIS_NEEDS_FLOW = 2, APSIS_NEEDS_EQUAL_STEPS = 4
  ! apsis_coefficients; C writes matrices row by row, so that Fortran reads the transposed
  integer(c_int), parameter :: APSIS_SHU_OSHER_P = 0, APSIS_SHU_OSHER_W = 1, APSIS_SHU_OSHER_D = 2, &
                               APSIS_SHU_OSHER_DDOT = 3, APSIS_SHU_OSHER_R = 4, APSIS_BUTCHER_A_HAT = 5, &
                               APSIS_BUTCHER_A = 6, APSIS_BUTCHER_A_DOT = 7
  ! apsis_counter
  integer(c_int), parameter :: APSIS_STEPS = 0, APSIS_REJECTED_STEPS = 1, APSIS_TRANSPORT_EVALUATIONS = 2, &
                               APSIS_STAGE_SOLVES = 3, APSIS_NEWTON_ITERATIONS = 4, APSIS_RATE_EVALUATIONS = 5, &
                               APSIS_JACOBIAN_EVALUATIONS = 6, APSIS_PRODUCT_EVALUATIONS = 7, APSIS_FLOW_EVALUATIONS = 8, &
                               APSIS_EVENTS = 9, APSIS_PREPARATIONS = 10, APSIS_PRECONDITIONER_SOLVES = 11

  ! Callbacks. A program declares its own with bind(c) and passes c_funloc(name).
  abstract interface
    integer(c_int) function apsis_transport_function(t, n, u, out, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: u(n)
      real(c_double), intent(out) :: out(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_stage_function(t, a, b, n, u, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t, a, b
      integer(c_size_t), value :: n
      real(c_double), intent(inout) :: u(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_flow_function(t, s, n, u, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t, s
      integer(c_size_t), value :: n
      real(c_double), intent(inout) :: u(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_rate_function(block, n, u, q, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n)
      real(c_double), intent(out) :: q(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_timed_rate_function(t, block, n, u, q, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n)
      real(c_double), intent(out) :: q(n)
      type(c_ptr), value :: data
    end function
    ! jacobian(j, i) is dQ_i/du_j
    integer(c_int) function apsis_jacobian_function(block, n, u, jacobian, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n)
      real(c_double), intent(out) :: jacobian(n, n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_product_function(block, n, u, x, jx, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n), x(n)
      real(c_double), intent(out) :: jx(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_timed_product_function(t, block, n, u, x, jx, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n), x(n)
      real(c_double), intent(out) :: jx(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_curvature_function(block, n, u, k, x, hx, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n), k(n), x(n)
      real(c_double), intent(out) :: hx(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_time_function(t, n, u, result, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: u(n)
      real(c_double), intent(out) :: result
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_prepare_function(t, gamma, block, n, u, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t, gamma
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_precondition_function(t, gamma, block, n, u, r, x, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t, gamma
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n), r(n)
      real(c_double), intent(out) :: x(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_admissible_function(block, n, u, result, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      integer(c_size_t), value :: block, n
      real(c_double), intent(in) :: u(n)
      integer(c_int), intent(out) :: result
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_observer_function(step, t, dt, n, u, data) bind(c)
      import :: c_double, c_int, c_long_long, c_ptr, c_size_t
      integer(c_long_long), value :: step
      real(c_double), value :: t, dt
      integer(c_size_t), value :: n
      real(c_double), intent(in) :: u(n)
      type(c_ptr), value :: data
    end function
    integer(c_int) function apsis_event_function(t, n, u, count, g, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      real(c_double), value :: t
      integer(c_size_t), value :: n, count
      real(c_double), intent(in) :: u(n)
      real(c_double), intent(out) :: g(count)
      type(c_ptr), value :: data
    end function
    ! k is the number of the function, from 0
    integer(c_int) function apsis_event_observer_function(k, t, n, u, data) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      integer(c_size_t), value :: k, n
      real(c_double), value :: t
      real(c_double), intent(in) :: u(n)
      type(c_ptr), value :: data
    end function
  end interface

  interface
    integer(c_int) function apsis_abi_version() bind(c)
      import :: c_int
    end function
    type(c_ptr) function apsis_version() bind(c)
      import :: c_ptr
    end function
    type(c_ptr) function apsis_error_message() bind(c)
      import :: c_ptr
    end function
    integer(c_int) function apsis_store_error(status, message) bind(c)
      import :: c_char, c_int
      integer(c_int), value :: status
      character(kind=c_char), intent(in) :: message(*)
    end function

    integer(c_size_t) function apsis_catalogue_size() bind(c)
      import :: c_size_t
    end function
    type(c_ptr) function apsis_catalogue_name(index) bind(c)
      import :: c_ptr, c_size_t
      integer(c_size_t), value :: index
    end function
    integer(c_int) function apsis_find_method(name, method) bind(c)
      import :: c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: name(*)
      type(c_ptr), intent(out) :: method
    end function
    subroutine apsis_free_method(method) bind(c)
      import :: c_ptr
      type(c_ptr), value :: method
    end subroutine
    type(c_ptr) function apsis_method_name(method) bind(c)
      import :: c_ptr
      type(c_ptr), value :: method
    end function
    type(c_ptr) function apsis_method_title(method) bind(c)
      import :: c_ptr
      type(c_ptr), value :: method
    end function
    type(c_ptr) function apsis_method_kind(method) bind(c)
      import :: c_ptr
      type(c_ptr), value :: method
    end function
    integer(c_int) function apsis_method_order(method) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: method
    end function
    integer(c_int) function apsis_method_steps(method) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: method
    end function
    integer(c_size_t) function apsis_method_stages(method) bind(c)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: method
    end function
    real(c_double) function apsis_method_ssp_coefficient(method) bind(c)
      import :: c_double, c_ptr
      type(c_ptr), value :: method
    end function
    integer(c_int) function apsis_method_needs(method) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: method
    end function
    integer(c_int) function apsis_method_coefficients(method, which, values) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: method
      integer(c_int), value :: which
      real(c_double), intent(out) :: values(*)
    end function
    integer(c_int) function apsis_method_file(method, text) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: method
      type(c_ptr), intent(out) :: text
    end function
    integer(c_int) function apsis_method_certificate(method, text) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: method
      type(c_ptr), intent(out) :: text
    end function
    integer(c_int) function apsis_method_fact(method, key, value) bind(c)
      import :: c_char, c_double, c_int, c_ptr
      type(c_ptr), value :: method
      character(kind=c_char), intent(in) :: key(*)
      real(c_double), intent(out) :: value
    end function

    integer(c_int) function apsis_new_integrator(method, n, integrator) bind(c)
      import :: c_int, c_ptr, c_size_t
      type(c_ptr), value :: method
      integer(c_size_t), value :: n
      type(c_ptr), intent(out) :: integrator
    end function
    subroutine apsis_free_integrator(integrator) bind(c)
      import :: c_ptr
      type(c_ptr), value :: integrator
    end subroutine
    integer(c_int) function apsis_set_data(integrator, data) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: integrator, data
    end function
    integer(c_int) function apsis_set_transport(integrator, transport) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: transport
    end function
    integer(c_int) function apsis_set_stage(integrator, stage) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: stage
    end function
    integer(c_int) function apsis_set_rate(integrator, rate) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: rate
    end function
    integer(c_int) function apsis_set_timed_rate(integrator, rate) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: rate
    end function
    integer(c_int) function apsis_set_jacobian(integrator, jacobian) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: jacobian
    end function
    integer(c_int) function apsis_set_product(integrator, product) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: product
    end function
    integer(c_int) function apsis_set_timed_product(integrator, product) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: product
    end function
    ! rows and columns count from 0
    integer(c_int) function apsis_set_sparsity(integrator, count, rows, columns) bind(c)
      import :: c_int, c_ptr, c_size_t
      type(c_ptr), value :: integrator
      integer(c_size_t), value :: count
      integer(c_size_t), intent(in) :: rows(count), columns(count)
    end function
    ! rows and columns count from 0
    integer(c_int) function apsis_set_mass(integrator, count, rows, columns, values) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      type(c_ptr), value :: integrator
      integer(c_size_t), value :: count
      integer(c_size_t), intent(in) :: rows(count), columns(count)
      real(c_double), intent(in) :: values(count)
    end function
    integer(c_int) function apsis_set_curvature(integrator, curvature) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: curvature
    end function
    integer(c_int) function apsis_set_flow(integrator, flow) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: flow
    end function
    integer(c_int) function apsis_set_block_size(integrator, size) bind(c)
      import :: c_int, c_ptr, c_size_t
      type(c_ptr), value :: integrator
      integer(c_size_t), value :: size
    end function
    integer(c_int) function apsis_set_dense_limit(integrator, unknowns) bind(c)
      import :: c_int, c_ptr, c_size_t
      type(c_ptr), value :: integrator
      integer(c_size_t), value :: unknowns
    end function
    integer(c_int) function apsis_set_admissible(integrator, admissible) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: admissible
    end function
    integer(c_int) function apsis_set_relaxation_time(integrator, relaxation_time) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: relaxation_time
    end function
    integer(c_int) function apsis_set_step(integrator, dt) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: dt
    end function
    integer(c_int) function apsis_set_preconditioner(integrator, prepare, solve) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: prepare, solve
    end function
    integer(c_int) function apsis_set_first_step(integrator, dt) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: dt
    end function
    integer(c_int) function apsis_set_forward_euler_step(integrator, step) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: step
    end function
    integer(c_int) function apsis_set_safety(integrator, safety) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: safety
    end function
    integer(c_int) function apsis_set_tolerance(integrator, relative, absolute) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: relative, absolute
    end function
    integer(c_int) function apsis_set_tolerances(integrator, relative, absolute) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: relative
      real(c_double), intent(in) :: absolute(*)
    end function
    integer(c_int) function apsis_set_controller(integrator, name) bind(c)
      import :: c_char, c_int, c_ptr
      type(c_ptr), value :: integrator
      character(kind=c_char), intent(in) :: name(*)
    end function
    integer(c_int) function apsis_set_graded_start(integrator, growth) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: integrator
      integer(c_int), value :: growth
    end function
    integer(c_int) function apsis_set_observer(integrator, observer) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: observer
    end function
    integer(c_int) function apsis_set_events(integrator, count, events, directions, ends) bind(c)
      import :: c_funptr, c_int, c_ptr, c_size_t
      type(c_ptr), value :: integrator
      integer(c_size_t), value :: count
      type(c_funptr), value :: events
      type(c_ptr), value :: directions, ends  ! c_loc of integer(c_int) arrays, or c_null_ptr
    end function
    integer(c_int) function apsis_set_event_observer(integrator, observer) bind(c)
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: integrator
      type(c_funptr), value :: observer
    end function
    integer(c_int) function apsis_set_stop_times(integrator, count, times) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      type(c_ptr), value :: integrator
      integer(c_size_t), value :: count
      real(c_double), intent(in) :: times(*)
    end function
    integer(c_int) function apsis_start(integrator, t0, u0) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: t0
      real(c_double), intent(in) :: u0(*)
    end function
    integer(c_int) function apsis_integrate(integrator, t1) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: t1
    end function
    real(c_double) function apsis_time(integrator) bind(c)
      import :: c_double, c_ptr
      type(c_ptr), value :: integrator
    end function
    ! To be read by c_f_pointer(apsis_state(integrator), u, [n]).
    type(c_ptr) function apsis_state(integrator) bind(c)
      import :: c_ptr
      type(c_ptr), value :: integrator
    end function
    integer(c_int) function apsis_state_at(integrator, t, u) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: integrator
      real(c_double), value :: t
      real(c_double), intent(out) :: u(*)
    end function
    integer(c_int) function apsis_found_event(integrator, index, k, t) bind(c)
      import :: c_double, c_int, c_ptr, c_size_t
      type(c_ptr), value :: integrator
      integer(c_size_t), value :: index
      integer(c_size_t), intent(out) :: k
      real(c_double), intent(out) :: t
    end function
    integer(c_long_long) function apsis_count(integrator, counter) bind(c)
      import :: c_int, c_long_long, c_ptr
      type(c_ptr), value :: integrator
      integer(c_int), value :: counter
    end function
    subroutine apsis_relaxation_weights(a, b, k, of_u, of_e) bind(c)
      import :: c_double
      real(c_double), value :: a, b, k
      real(c_double), intent(out) :: of_u, of_e
    end subroutine
  end interface

contains

  ! Returns a text of C, "" for NULL.
  function apsis_string(text) result(string)
    type(c_ptr), intent(in) :: text
    character(len=:), allocatable :: string
    character(kind=c_char), pointer :: letters(:)
    integer :: length, i
    string = ""
    if (.not. c_associated(text)) return
    length = 0
    do
      call c_f_pointer(text, letters, [length + 1])
      if (letters(length + 1) == c_null_char) exit
      length = length + 1
    end do
    string = repeat(" ", length)
    do i = 1, length
      string(i:i) = letters(i)
    end do
  end function

end module
