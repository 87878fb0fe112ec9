! A host in miniature: one material point of ISO_PLASTIC driven through a uniaxial tension-compression loop by UMAT, and
! a block of points sheared by VUMAT. See README.md.
program fortran_host
   use, intrinsic :: iso_fortran_env, only: real64
   use lode_interfaces, only: umat, vumat
   implicit none

   real(real64), parameter :: young = 200000, poisson = 0.3_real64, yield = 400, hardening = 2000
   real(real64), parameter :: props(5) = [young, poisson, yield, 1.0_real64, hardening]
   integer, parameter :: nstatv = 4
   character(len=80), parameter :: cmname = 'ISO_PLASTIC-STEEL'

   call tension_compression
   call sheared_block

contains

   ! Strain 0 -> 0.01 -> -0.01 -> 0.01 along 11; the lateral strain increments are found such that stress 22 and 33
   ! vanish, with the tangent that UMAT returns.
   subroutine tension_compression
      integer, parameter :: increments = 20
      real(real64), parameter :: targets(3) = [0.01_real64, -0.01_real64, 0.01_real64]
      real(real64) :: stress(6), stress_start(6), statev(nstatv), statev_start(nstatv)
      real(real64) :: ddsdde(6, 6), stran(6), dstran(6), correction(2), pnewdt, time
      integer :: leg, increment, iteration, total

      stress_start = 0
      statev_start = 0
      stran = 0
      time = 0
      total = 0
      print '(a)', 'UMAT: uniaxial tension-compression loop'
      print '(a5, 2a14, a14, a14, a6)', 'inc', 'strain 11', 'stress 11', 'strain 22', 'EQPS', 'iter'
      do leg = 1, size(targets)
         do increment = 1, increments
            total = total + 1
            dstran = 0
            dstran(1) = (targets(leg) - stran(1))/(increments - increment + 1)
            dstran(2:3) = -poisson*dstran(1)
            do iteration = 1, 30
               stress = stress_start
               statev = statev_start
               call call_umat(stress, statev, ddsdde, stran, dstran, time, total, pnewdt)
               if (pnewdt < 1) error stop 'UMAT asks for a smaller increment'
               if (maxval(abs(stress(2:3))) < 1e-10_real64*yield) exit
               correction = solve_2x2(ddsdde(2:3, 2:3), -stress(2:3))
               dstran(2:3) = dstran(2:3) + correction
            end do
            if (iteration > 30) error stop 'the lateral strains did not converge'
            stran = stran + dstran
            stress_start = stress
            statev_start = statev
            time = time + 1
            if (mod(increment, 5) == 0) &
               print '(i5, f14.6, f14.6, f14.8, f14.8, i6)', total, stran(1), stress(1), stran(2), statev(1), iteration
         end do
      end do
   end subroutine tension_compression

   subroutine call_umat(stress, statev, ddsdde, stran, dstran, start, kinc, pnewdt)
      real(real64), intent(inout) :: stress(6), statev(nstatv), ddsdde(6, 6)
      real(real64), intent(in) :: stran(6), dstran(6), start
      integer, intent(in) :: kinc
      real(real64), intent(out) :: pnewdt
      real(real64), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1]*1.0_real64, [3, 3])
      real(real64), parameter :: none(1) = [0.0_real64]
      integer, parameter :: jstep(4) = [1, 1, 0, 0]
      real(real64) :: sse, spd, scd, rpl, ddsddt(6), drplde(6), drpldt

      sse = 0
      spd = 0
      scd = 0
      pnewdt = 1
      call umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, [start, start], &
                1.0_real64, 293.0_real64, 0.0_real64, none, none, cmname, 3, 3, 6, nstatv, props, size(props), &
                [0.0_real64, 0.0_real64, 0.0_real64], identity, pnewdt, 1.0_real64, identity, identity, 1, 1, 1, 1, &
                jstep, kinc)
   end subroutine call_umat

   pure function solve_2x2(a, b) result(x)
      real(real64), intent(in) :: a(2, 2), b(2)
      real(real64) :: x(2)
      x = [a(2, 2)*b(1) - a(1, 2)*b(2), a(1, 1)*b(2) - a(2, 1)*b(1)]/(a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1))
   end function solve_2x2

   ! Simple shear 12 in 10 steps; the points of the block differ by their final shear angle.
   subroutine sheared_block
      integer, parameter :: n = 8, steps = 10, ndir = 3, nshr = 3, ncomp = ndir + nshr
      real(real64), parameter :: dt = 1e-6_real64, density(n) = 7.85e-9_real64
      real(real64) :: angle(n), straininc(n, ncomp), spin(n, nshr), coord(n, 3), length(n), temperature(n)
      real(real64) :: stretch_old(n, ncomp), stretch(n, ncomp), f_old(n, ncomp + nshr), f(n, ncomp + nshr), field(n, 0)
      real(real64) :: stress_old(n, ncomp), stress(n, ncomp), state_old(n, nstatv), state(n, nstatv)
      real(real64), dimension(n) :: energy_old, energy, dissipated_old, dissipated
      integer :: step, k

      angle = [(0.002_real64*k, k=1, n)]
      straininc = 0
      straininc(:, 4) = 0.5_real64*angle/steps   ! tensor shear
      spin = 0
      coord = 0
      length = 1
      temperature = 293
      stretch = 0
      stretch(:, 1:3) = 1
      f = 0
      f(:, 1:3) = 1
      stress = 0
      state = 0
      energy = 0
      dissipated = 0
      do step = 1, steps
         stress_old = stress
         state_old = state
         energy_old = energy
         dissipated_old = dissipated
         stretch_old = stretch
         f_old = f
         f(:, 4) = angle*step/steps
         stretch(:, 4) = 0.5_real64*f(:, 4)   ! small angles
         call vumat(n, ndir, nshr, nstatv, 0, size(props), 0, step*dt, step*dt, dt, cmname, coord, length, props, &
                    density, straininc, spin, temperature, stretch_old, f_old, field, stress_old, state_old, &
                    energy_old, dissipated_old, temperature, stretch, f, field, stress, state, energy, dissipated)
      end do
      print '(/a)', 'VUMAT: a block of points in simple shear'
      print '(a5, a14, a14, a14)', 'point', 'angle', 'stress 12', 'EQPS'
      do k = 1, n
         print '(i5, f14.6, f14.6, f14.8)', k, angle(k), stress(k, 4), state(k, 1)
      end do
   end subroutine sheared_block
end program fortran_host
