! The model of the paper in Fortran: u1' = u2, u2' = (1 + u1^2)(sin u1 - u2)/epsilon, u(0) = (2, 0).
module model
  use, intrinsic :: iso_c_binding
  use apsis
  implicit none

  type :: parameters
    real(c_double) :: epsilon
    integer(c_int) :: observed = 0
  end type

contains

  integer(c_int) function transport(t, n, u, out, data) bind(c)
    real(c_double), value :: t
    integer(c_size_t), value :: n
    real(c_double), intent(in) :: u(n)
    real(c_double), intent(out) :: out(n)
    type(c_ptr), value :: data
    out(1) = u(2)
    out(2) = 0
    transport = 0
    if (t < 0 .or. .not. c_associated(data)) transport = -1
  end function

  integer(c_int) function rate(block, n, u, q, data) bind(c)
    integer(c_size_t), value :: block, n
    real(c_double), intent(in) :: u(n)
    real(c_double), intent(out) :: q(n)
    type(c_ptr), value :: data
    type(parameters), pointer :: p
    call c_f_pointer(data, p)
    q(1) = 0
    q(2) = (1 + u(1)**2) * (sin(u(1)) - u(2)) / p%epsilon
    rate = 0
    if (block /= 0) rate = -1
  end function

  integer(c_int) function jacobian_product(block, n, u, x, jx, data) bind(c)
    integer(c_size_t), value :: block, n
    real(c_double), intent(in) :: u(n), x(n)
    real(c_double), intent(out) :: jx(n)
    type(c_ptr), value :: data
    type(parameters), pointer :: p
    call c_f_pointer(data, p)
    jx(1) = 0
    jx(2) = ((2 * u(1) * (sin(u(1)) - u(2)) + (1 + u(1)**2) * cos(u(1))) * x(1) - (1 + u(1)**2) * x(2)) / p%epsilon
    jacobian_product = 0
    if (block /= 0) jacobian_product = -1
  end function

  integer(c_int) function observer(step, t, dt, n, u, data) bind(c)
    integer(c_long_long), value :: step
    real(c_double), value :: t, dt
    integer(c_size_t), value :: n
    real(c_double), intent(in) :: u(n)
    type(c_ptr), value :: data
    type(parameters), pointer :: p
    call c_f_pointer(data, p)
    p%observed = p%observed + 1
    observer = 0
    if (step /= p%observed .or. abs(t - step * dt) > 1e-12 .or. size(u) /= 2) observer = -1
  end function

  integer(c_int) function level(t, n, u, count, g, data) bind(c)
    real(c_double), value :: t
    integer(c_size_t), value :: n, count
    real(c_double), intent(in) :: u(n)
    real(c_double), intent(out) :: g(count)
    type(c_ptr), value :: data
    g(1) = u(1) - 2.5_c_double
    level = 0
    if (t < 0 .or. .not. c_associated(data)) level = -1
  end function

  ! 2 u1' + u2'/2 = t - u1 + 5/2 and 6 u2' = 3 (t - u2) + 6 have the solution u1 = u2 = t.
  integer(c_int) function timed_rate(t, block, n, u, q, data) bind(c)
    real(c_double), value :: t
    integer(c_size_t), value :: block, n
    real(c_double), intent(in) :: u(n)
    real(c_double), intent(out) :: q(n)
    type(c_ptr), value :: data
    q(1) = t - u(1) + 2.5_c_double
    q(2) = 3 * (t - u(2)) + 6
    timed_rate = 0
    if (block /= 0 .or. .not. c_associated(data)) timed_rate = -1
  end function

  integer(c_int) function timed_product(t, block, n, u, x, jx, data) bind(c)
    real(c_double), value :: t
    integer(c_size_t), value :: block, n
    real(c_double), intent(in) :: u(n), x(n)
    real(c_double), intent(out) :: jx(n)
    type(c_ptr), value :: data
    jx(1) = -x(1)
    jx(2) = -3 * x(2)
    timed_product = 0
    if (block /= 0 .or. t < 0 .or. size(u) /= 2 .or. .not. c_associated(data)) timed_product = -1
  end function

  ! Checks a system with a mass matrix, sparse stages and a collision that depends on time.
  subroutine check_mass(p)
    type(parameters), target, intent(inout) :: p
    real(c_double), pointer :: u(:)
    type(c_ptr) :: method, s
    integer(c_size_t), parameter :: rows(3) = [0, 0, 1], columns(3) = [0, 1, 1]
    call check(apsis_find_method("imdrk-3-3" // c_null_char, method) == APSIS_OK, "method")
    call check(apsis_new_integrator(method, 2_c_size_t, s) == APSIS_OK, "integrator")
    call apsis_free_method(method)
    call check(apsis_set_data(s, c_loc(p)) == APSIS_OK, "data")
    call check(apsis_set_timed_rate(s, c_funloc(timed_rate)) == APSIS_OK, "rate of time")
    call check(apsis_set_timed_product(s, c_funloc(timed_product)) == APSIS_OK, "product of time")
    call check(apsis_set_sparsity(s, 3_c_size_t, rows, columns) == APSIS_OK, "sparsity")
    call check(apsis_set_mass(s, 3_c_size_t, rows, columns, [2.0_c_double, 0.5_c_double, 6.0_c_double]) == APSIS_OK, "mass")
    call check(apsis_set_step(s, 0.125_c_double) == APSIS_OK, "step")
    call check(apsis_start(s, 0.0_c_double, [0.0_c_double, 0.0_c_double]) == APSIS_OK, "start")
    call check(apsis_integrate(s, 1.0_c_double) == APSIS_OK, "integrate")
    call c_f_pointer(apsis_state(s), u, [2])
    ! A method of any order is exact; differences of q in time have ten digits.
    call check(maxval(abs(u - 1)) < 1e-9_c_double, "the solution t")
    call check(apsis_set_first_step(s, -1.0_c_double) == APSIS_INPUT_ERROR, "a negative first step")
    call check(index(apsis_string(apsis_error_message()), "the first step is -1") > 0, "its message")
    call apsis_free_integrator(s)
  end subroutine

  ! Stops with a message unless the condition holds.
  subroutine check(condition, what)
    logical, intent(in) :: condition
    character(len=*), intent(in) :: what
    if (condition) return
    print *, what, ": ", apsis_string(apsis_error_message())
    stop 1
  end subroutine

  ! Returns u(1) after the given number of steps of a method.
  function solution(name, p, steps) result(u1)
    character(len=*), intent(in) :: name
    type(parameters), target, intent(inout) :: p
    integer, intent(in) :: steps
    real(c_double) :: u1(2)
    real(c_double), pointer :: u(:)
    type(c_ptr) :: method, s
    integer(c_size_t) :: k
    real(c_double) :: t, at(2)
    p%observed = 0
    call check(apsis_find_method(name // c_null_char, method) == APSIS_OK, "method")
    call check(apsis_new_integrator(method, 2_c_size_t, s) == APSIS_OK, "integrator")
    call apsis_free_method(method)
    call check(apsis_set_data(s, c_loc(p)) == APSIS_OK, "data")
    call check(apsis_set_transport(s, c_funloc(transport)) == APSIS_OK, "transport")
    call check(apsis_set_rate(s, c_funloc(rate)) == APSIS_OK, "rate")
    call check(apsis_set_product(s, c_funloc(jacobian_product)) == APSIS_OK, "product")
    call check(apsis_set_observer(s, c_funloc(observer)) == APSIS_OK, "observer")
    call check(apsis_set_step(s, 1.0_c_double / steps) == APSIS_OK, "step")
    call check(apsis_start(s, 0.0_c_double, [2.0_c_double, 0.0_c_double]) == APSIS_OK, "start")
    call check(apsis_integrate(s, 1.0_c_double) == APSIS_OK, "integrate")
    call check(apsis_count(s, APSIS_STEPS) == steps .and. p%observed == steps, "count")
    call c_f_pointer(apsis_state(s), u, [2])
    u1 = u

    ! u1 rises through 2.5, where dense output has that value.
    p%observed = 0
    call check(apsis_set_observer(s, c_null_funptr) == APSIS_OK, "no observer")
    call check(apsis_set_events(s, 1_c_size_t, c_funloc(level), c_null_ptr, c_null_ptr) == APSIS_OK, "events")
    call check(apsis_start(s, 0.0_c_double, [2.0_c_double, 0.0_c_double]) == APSIS_OK, "start again")
    call check(apsis_integrate(s, 1.0_c_double) == APSIS_EVENT, "an event")
    call check(apsis_count(s, APSIS_EVENTS) == 1, "one event")
    call check(apsis_found_event(s, 0_c_size_t, k, t) == APSIS_OK, "what was found")
    call check(k == 0 .and. t > 0, "its function")
    call check(apsis_state_at(s, t, at) == APSIS_OK, "dense output")
    call check(abs(at(1) - 2.5_c_double) < 1e-12_c_double, "the state of the event")
    call apsis_free_integrator(s)
  end function

end module

program model_of_the_paper
  use, intrinsic :: iso_c_binding
  use apsis
  use model
  implicit none
  type(parameters), target :: p
  type(c_ptr) :: none
  real(c_double) :: reference(2), coarse, fine
  integer(c_int) :: status

  call check(apsis_abi_version() == APSIS_MODULE_ABI_VERSION, "ABI")

  ! The reference solution of examples/quickstart.cpp, to its digits.
  p%epsilon = 1e-8_c_double
  reference = [2.677671_c_double, 0.447459_c_double]
  call check(sum(abs(solution("md-imex-6-3", p, 64) - reference)) < 1e-6, "the model of the paper")

  ! Order 3 at epsilon = 1, against 1024 steps, whose errors are 500 times smaller.
  p%epsilon = 1
  reference = solution("md-imex-6-3", p, 1024)
  coarse = sum(abs(solution("md-imex-6-3", p, 64) - reference))
  fine = sum(abs(solution("md-imex-6-3", p, 128) - reference))
  call check(abs(log(coarse / fine) / log(2.0_c_double) - 3) < 0.2, "order 3")

  call check_mass(p)

  status = apsis_find_method("md-imex-6-33" // c_null_char, none)
  call check(status == APSIS_INPUT_ERROR .and. .not. c_associated(none), "an unknown method")
  call check(index(apsis_string(apsis_error_message()), "did you mean 'md-imex-6-3'?") > 0, "its message")
  print *, "0 failures"
end program
