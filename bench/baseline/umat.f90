! Lean UMATs as a careful author writes them by hand: what the library is measured against.
! Three-dimensional, UMAT order 11, 22, 33, 12, 13, 23, engineering shears. Each does exactly what its model needs and
! nothing else: no argument checks, no thermal strain, no options.

! Isotropic linear elasticity. PROPS: E, nu
subroutine baseline_umat_elastic(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                                 time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                                 nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, &
                                 kinc)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
   real(real64), intent(inout) :: stress(6), statev(*), ddsdde(6, 6), sse, spd, scd, rpl, ddsddt(6), drplde(6), drpldt
   real(real64), intent(in) :: stran(6), dstran(6), time(2), dtime, temp, dtemp, predef(*), dpred(*), props(*)
   real(real64), intent(in) :: coords(3), drot(3, 3), celent, dfgrd0(3, 3), dfgrd1(3, 3)
   real(real64), intent(inout) :: pnewdt
   character(len=80), intent(in) :: cmname
   real(real64) :: shear, lambda, increment(6)
   integer :: i

   shear = props(1)/(2*(1 + props(2)))
   lambda = 2*shear*props(2)/(1 - 2*props(2))
   increment(1:3) = lambda*(dstran(1) + dstran(2) + dstran(3)) + 2*shear*dstran(1:3)
   increment(4:6) = shear*dstran(4:6)
   sse = sse + dot_product(stress + 0.5_real64*increment, dstran)
   stress = stress + increment

   ddsdde = 0
   ddsdde(1:3, 1:3) = lambda
   do i = 1, 3
      ddsdde(i, i) = lambda + 2*shear
      ddsdde(i + 3, i + 3) = shear
   end do
end subroutine baseline_umat_elastic

! J2 with linear isotropic hardening, closed-form radial return. PROPS: E, nu, yield stress, H. STATEV: eq. plastic strain
subroutine baseline_umat_j2(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                            time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                            nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
   real(real64), intent(inout) :: stress(6), statev(*), ddsdde(6, 6), sse, spd, scd, rpl, ddsddt(6), drplde(6), drpldt
   real(real64), intent(in) :: stran(6), dstran(6), time(2), dtime, temp, dtemp, predef(*), dpred(*), props(*)
   real(real64), intent(in) :: coords(3), drot(3, 3), celent, dfgrd0(3, 3), dfgrd1(3, 3)
   real(real64), intent(inout) :: pnewdt
   character(len=80), intent(in) :: cmname
   real(real64), parameter :: third = 1/3.0_real64
   real(real64) :: shear, bulk, s(6), mean, q, flow, dp, beta, gamma, lambda, compliance, inverse_q, old(6)
   integer :: i, j

   shear = props(1)/(2*(1 + props(2)))
   bulk = props(1)/(3*(1 - 2*props(2)))
   lambda = bulk - 2*third*shear
   old = stress

   mean = lambda*(dstran(1) + dstran(2) + dstran(3))
   stress(1:3) = stress(1:3) + mean + 2*shear*dstran(1:3)
   stress(4:6) = stress(4:6) + shear*dstran(4:6)
   mean = third*(stress(1) + stress(2) + stress(3))
   s(1:3) = stress(1:3) - mean
   s(4:6) = stress(4:6)
   q = sqrt(1.5_real64*(s(1)**2 + s(2)**2 + s(3)**2) + 3*(s(4)**2 + s(5)**2 + s(6)**2))
   flow = props(3) + props(4)*statev(1)

   if (q > flow) then
      ! Divisions are what this routine costs: each reciprocal is formed once.
      compliance = 1/(3*shear + props(4))
      inverse_q = 1/q
      dp = (q - flow)*compliance
      beta = 1 - 3*shear*dp*inverse_q
      gamma = 9*shear**2*(compliance - dp*inverse_q)*inverse_q**2
      stress(1:3) = mean + beta*s(1:3)
      stress(4:6) = beta*s(4:6)
      statev(1) = statev(1) + dp
      spd = spd + (flow + 0.5_real64*props(4)*dp)*dp
      sse = sse + 0.5_real64*dot_product(old + stress, dstran) - (flow + 0.5_real64*props(4)*dp)*dp
      ! Each entry is stored once: adding to entries just stored costs as much as all the rest.
      lambda = bulk - 2*third*shear*beta
      do j = 1, 3
         ddsdde(1:3, j) = lambda - gamma*s(j)*s(1:3)
         ddsdde(4:6, j) = -gamma*s(j)*s(4:6)
         ddsdde(j, j) = lambda + 2*shear*beta - gamma*s(j)**2
      end do
      do j = 4, 6
         ddsdde(:, j) = -gamma*s(j)*s
         ddsdde(j, j) = shear*beta - gamma*s(j)**2
      end do
   else
      sse = sse + 0.5_real64*dot_product(old + stress, dstran)
      ddsdde = 0
      ddsdde(1:3, 1:3) = lambda
      do i = 1, 3
         ddsdde(i, i) = lambda + 2*shear
         ddsdde(i + 3, i + 3) = shear
      end do
   end if
end subroutine baseline_umat_j2

! The same model in the usual form: loops over NDI and NTENS, the elastic matrix first, as tutorials have it.
subroutine baseline_umat_j2_usual(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                                  time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                                  nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, &
                                  jstep, kinc)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
   real(real64), intent(inout) :: stress(ntens), statev(*), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens)
   real(real64), intent(inout) :: drplde(ntens), drpldt
   real(real64), intent(in) :: stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(*), dpred(*), props(*)
   real(real64), intent(in) :: coords(3), drot(3, 3), celent, dfgrd0(3, 3), dfgrd1(3, 3)
   real(real64), intent(inout) :: pnewdt
   character(len=80), intent(in) :: cmname
   real(real64) :: shear, bulk, lambda, flow(6), old(6), mean, mises, yield, dp, effective_shear, effective_hardening
   real(real64) :: effective_lambda, work
   integer :: i, j

   shear = props(1)/(1 + props(2))/2
   bulk = props(1)/(1 - 2*props(2))/3
   lambda = bulk - 2*shear/3
   do j = 1, ntens
      do i = 1, ntens
         ddsdde(i, j) = 0
      end do
   end do
   do j = 1, ndi
      do i = 1, ndi
         ddsdde(i, j) = lambda
      end do
      ddsdde(j, j) = lambda + 2*shear
   end do
   do j = ndi + 1, ntens
      ddsdde(j, j) = shear
   end do
   do i = 1, ntens
      old(i) = stress(i)
   end do
   do j = 1, ntens
      do i = 1, ntens
         stress(i) = stress(i) + ddsdde(i, j)*dstran(j)
      end do
   end do

   mises = (stress(1) - stress(2))**2 + (stress(2) - stress(3))**2 + (stress(3) - stress(1))**2
   do i = ndi + 1, ntens
      mises = mises + 6*stress(i)**2
   end do
   mises = sqrt(mises/2)
   yield = props(3) + props(4)*statev(1)
   dp = 0
   if (mises > yield) then
      mean = (stress(1) + stress(2) + stress(3))/3
      do i = 1, ndi
         flow(i) = (stress(i) - mean)/mises
      end do
      do i = ndi + 1, ntens
         flow(i) = stress(i)/mises
      end do
      dp = (mises - yield)/(3*shear + props(4))
      yield = yield + props(4)*dp
      do i = 1, ndi
         stress(i) = flow(i)*yield + mean
      end do
      do i = ndi + 1, ntens
         stress(i) = flow(i)*yield
      end do
      statev(1) = statev(1) + dp
      effective_shear = shear*yield/mises
      effective_lambda = bulk - 2*effective_shear/3
      effective_hardening = 3*shear*props(4)/(3*shear + props(4)) - 3*effective_shear
      do j = 1, ndi
         do i = 1, ndi
            ddsdde(i, j) = effective_lambda
         end do
         ddsdde(j, j) = 2*effective_shear + effective_lambda
      end do
      do j = ndi + 1, ntens
         ddsdde(j, j) = effective_shear
      end do
      do j = 1, ntens
         do i = 1, ntens
            ddsdde(i, j) = ddsdde(i, j) + effective_hardening*flow(i)*flow(j)
         end do
      end do
   end if
   work = 0
   do i = 1, ntens
      work = work + (old(i) + stress(i))*dstran(i)/2
   end do
   mean = (yield - props(4)*dp/2)*dp
   spd = spd + mean
   sse = sse + work - mean
end subroutine baseline_umat_j2_usual

! J2 with hardening Y + Q (1 - exp(-k p)) + H p, Newton. PROPS: E, nu, Y, Q, k, H. STATEV: eq. plastic strain
subroutine baseline_umat_j2_voce(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                                 time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                                 nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, &
                                 kinc)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
   real(real64), intent(inout) :: stress(6), statev(*), ddsdde(6, 6), sse, spd, scd, rpl, ddsddt(6), drplde(6), drpldt
   real(real64), intent(in) :: stran(6), dstran(6), time(2), dtime, temp, dtemp, predef(*), dpred(*), props(*)
   real(real64), intent(in) :: coords(3), drot(3, 3), celent, dfgrd0(3, 3), dfgrd1(3, 3)
   real(real64), intent(inout) :: pnewdt
   character(len=80), intent(in) :: cmname
   real(real64) :: shear, bulk, s(6), mean, q, flow, flow_old, slope, saturation, dp, residual, beta, gamma, lambda
   real(real64), parameter :: third = 1/3.0_real64
   real(real64) :: old(6), work, inverse_q
   integer :: i, j, iteration

   shear = props(1)/(2*(1 + props(2)))
   bulk = props(1)/(3*(1 - 2*props(2)))
   lambda = bulk - 2*third*shear
   old = stress

   mean = lambda*(dstran(1) + dstran(2) + dstran(3))
   stress(1:3) = stress(1:3) + mean + 2*shear*dstran(1:3)
   stress(4:6) = stress(4:6) + shear*dstran(4:6)
   mean = third*(stress(1) + stress(2) + stress(3))
   s(1:3) = stress(1:3) - mean
   s(4:6) = stress(4:6)
   q = sqrt(1.5_real64*(s(1)**2 + s(2)**2 + s(3)**2) + 3*(s(4)**2 + s(5)**2 + s(6)**2))
   saturation = props(4)*exp(-props(5)*statev(1))
   flow_old = props(3) + props(4) - saturation + props(6)*statev(1)

   if (q > flow_old) then
      dp = 0
      flow = flow_old
      do iteration = 1, 50
         slope = props(5)*saturation + props(6)
         residual = q - 3*shear*dp - flow
         if (abs(residual) < 1e-13_real64*q) exit
         dp = dp + residual/(3*shear + slope)
         saturation = props(4)*exp(-props(5)*(statev(1) + dp))
         flow = props(3) + props(4) - saturation + props(6)*(statev(1) + dp)
      end do
      inverse_q = 1/q
      beta = 1 - 3*shear*dp*inverse_q
      gamma = 9*shear**2*(1/(3*shear + slope) - dp*inverse_q)*inverse_q**2
      stress(1:3) = mean + beta*s(1:3)
      stress(4:6) = beta*s(4:6)
      statev(1) = statev(1) + dp
      work = 0.5_real64*(flow_old + flow)*dp
      spd = spd + work
      sse = sse + 0.5_real64*dot_product(old + stress, dstran) - work
      ! Each entry is stored once: adding to entries just stored costs as much as all the rest.
      lambda = bulk - 2*third*shear*beta
      do j = 1, 3
         ddsdde(1:3, j) = lambda - gamma*s(j)*s(1:3)
         ddsdde(4:6, j) = -gamma*s(j)*s(4:6)
         ddsdde(j, j) = lambda + 2*shear*beta - gamma*s(j)**2
      end do
      do j = 4, 6
         ddsdde(:, j) = -gamma*s(j)*s
         ddsdde(j, j) = shear*beta - gamma*s(j)**2
      end do
   else
      sse = sse + 0.5_real64*dot_product(old + stress, dstran)
      ddsdde = 0
      ddsdde(1:3, 1:3) = lambda
      do i = 1, 3
         ddsdde(i, i) = lambda + 2*shear
         ddsdde(i + 3, i + 3) = shear
      end do
   end if
end subroutine baseline_umat_j2_voce

! Compressible neo-Hookean solid, tau = G (B - I) + lambda/2 (J**2 - 1) I, Jaumann tangent over J. PROPS: G, lambda
subroutine baseline_umat_neo_hooke(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                                   time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                                   nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, &
                                   jstep, kinc)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
   real(real64), intent(inout) :: stress(6), statev(*), ddsdde(6, 6), sse, spd, scd, rpl, ddsddt(6), drplde(6), drpldt
   real(real64), intent(in) :: stran(6), dstran(6), time(2), dtime, temp, dtemp, predef(*), dpred(*), props(*)
   real(real64), intent(in) :: coords(3), drot(3, 3), celent, dfgrd0(3, 3), dfgrd1(3, 3)
   real(real64), intent(inout) :: pnewdt
   character(len=80), intent(in) :: cmname
   real(real64) :: b(6), det, shear, volumetric, log_det
   associate (f => dfgrd1)
      det = f(1, 1)*(f(2, 2)*f(3, 3) - f(2, 3)*f(3, 2)) - f(1, 2)*(f(2, 1)*f(3, 3) - f(2, 3)*f(3, 1)) &
            + f(1, 3)*(f(2, 1)*f(3, 2) - f(2, 2)*f(3, 1))
      b(1) = f(1, 1)**2 + f(1, 2)**2 + f(1, 3)**2
      b(2) = f(2, 1)**2 + f(2, 2)**2 + f(2, 3)**2
      b(3) = f(3, 1)**2 + f(3, 2)**2 + f(3, 3)**2
      b(4) = f(1, 1)*f(2, 1) + f(1, 2)*f(2, 2) + f(1, 3)*f(2, 3)
      b(5) = f(1, 1)*f(3, 1) + f(1, 2)*f(3, 2) + f(1, 3)*f(3, 3)
      b(6) = f(2, 1)*f(3, 1) + f(2, 2)*f(3, 2) + f(2, 3)*f(3, 3)
   end associate
   shear = props(1)/det
   volumetric = 0.5_real64*props(2)*(det - 1/det)
   stress(1:3) = shear*(b(1:3) - 1) + volumetric
   stress(4:6) = shear*b(4:6)
   log_det = log(det)
   sse = (0.5_real64*props(1)*(b(1) + b(2) + b(3) - 3 - 2*log_det) &
          + 0.5_real64*props(2)*(0.5_real64*(det**2 - 1) - log_det))/det

   b = shear*b
   ddsdde = 0
   ddsdde(1:3, 1:3) = props(2)*det
   ddsdde(1, 1) = ddsdde(1, 1) + 2*b(1)
   ddsdde(2, 2) = ddsdde(2, 2) + 2*b(2)
   ddsdde(3, 3) = ddsdde(3, 3) + 2*b(3)
   ddsdde(4, 1) = b(4)
   ddsdde(5, 1) = b(5)
   ddsdde(4, 2) = b(4)
   ddsdde(6, 2) = b(6)
   ddsdde(5, 3) = b(5)
   ddsdde(6, 3) = b(6)
   ddsdde(1, 4) = b(4)
   ddsdde(2, 4) = b(4)
   ddsdde(4, 4) = 0.5_real64*(b(1) + b(2))
   ddsdde(5, 4) = 0.5_real64*b(6)
   ddsdde(6, 4) = 0.5_real64*b(5)
   ddsdde(1, 5) = b(5)
   ddsdde(3, 5) = b(5)
   ddsdde(4, 5) = 0.5_real64*b(6)
   ddsdde(5, 5) = 0.5_real64*(b(1) + b(3))
   ddsdde(6, 5) = 0.5_real64*b(4)
   ddsdde(2, 6) = b(6)
   ddsdde(3, 6) = b(6)
   ddsdde(4, 6) = 0.5_real64*b(5)
   ddsdde(5, 6) = 0.5_real64*b(4)
   ddsdde(6, 6) = 0.5_real64*(b(2) + b(3))
end subroutine baseline_umat_neo_hooke
