! Lean VUMATs: VUMAT order 11, 22, 33, 12, 23, 31, tensor shears, three-dimensional. Each updates stress, state and the
! two specific energies.
! `simd` marks the hand-vectorised form: no branch depends on a point, and the compiler is told that points are
! independent. The other form is the usual one: a loop over the block around code for one point.

! Isotropic linear elasticity. PROPS: E, nu. With four state variables it also keeps what ISO_ELASTIC keeps: the sum of
! the temperature increments in the third, the others and the inelastic energy as they are.
subroutine baseline_vumat_elastic(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, &
   cmname, coordmp, charlength, props, density, straininc, relspininc, tempold, stretchold, &
   defgradold, fieldold, stressold, stateold, enerinternold, enerinelasold, tempnew, &
   stretchnew, defgradnew, fieldnew, stressnew, statenew, enerinternnew, enerinelasnew)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal
   real(real64), intent(in) :: steptime, totaltime, dt, coordmp(nblock, *), charlength(nblock), props(*), density(nblock)
   character(len=80), intent(in) :: cmname
   real(real64), intent(in) :: straininc(nblock, 6), relspininc(nblock, 3), tempold(nblock), stretchold(nblock, 6)
   real(real64), intent(in) :: defgradold(nblock, 9), fieldold(nblock, *), stressold(nblock, 6), stateold(nblock, *)
   real(real64), intent(in) :: enerinternold(nblock), enerinelasold(nblock), tempnew(nblock), stretchnew(nblock, 6)
   real(real64), intent(in) :: defgradnew(nblock, 9), fieldnew(nblock, *)
   real(real64), intent(inout) :: stressnew(nblock, 6), statenew(nblock, *), enerinternnew(nblock), enerinelasnew(nblock)
   real(real64) :: lambda, shear2, volumetric, d(6)
   integer :: k

   shear2 = props(1)/(1 + props(2))
   lambda = shear2*props(2)/(1 - 2*props(2))
   !$omp simd private(d, volumetric)
   do k = 1, nblock
      volumetric = lambda*(straininc(k, 1) + straininc(k, 2) + straininc(k, 3))
      d(1) = volumetric + shear2*straininc(k, 1)
      d(2) = volumetric + shear2*straininc(k, 2)
      d(3) = volumetric + shear2*straininc(k, 3)
      d(4) = shear2*straininc(k, 4)
      d(5) = shear2*straininc(k, 5)
      d(6) = shear2*straininc(k, 6)
      stressnew(k, 1) = stressold(k, 1) + d(1)
      stressnew(k, 2) = stressold(k, 2) + d(2)
      stressnew(k, 3) = stressold(k, 3) + d(3)
      stressnew(k, 4) = stressold(k, 4) + d(4)
      stressnew(k, 5) = stressold(k, 5) + d(5)
      stressnew(k, 6) = stressold(k, 6) + d(6)
      enerinternnew(k) = enerinternold(k) + ((stressold(k, 1) + 0.5_real64*d(1))*straininc(k, 1) &
                                             + (stressold(k, 2) + 0.5_real64*d(2))*straininc(k, 2) &
                                             + (stressold(k, 3) + 0.5_real64*d(3))*straininc(k, 3) &
                                             + (2*stressold(k, 4) + d(4))*straininc(k, 4) &
                                             + (2*stressold(k, 5) + d(5))*straininc(k, 5) &
                                             + (2*stressold(k, 6) + d(6))*straininc(k, 6))/density(k)
   end do
   if (nstatev < 4) return
   !$omp simd
   do k = 1, nblock
      statenew(k, 1) = stateold(k, 1)
      statenew(k, 2) = stateold(k, 2)
      statenew(k, 3) = stateold(k, 3) + (tempnew(k) - tempold(k))
      statenew(k, 4) = stateold(k, 4)
      enerinelasnew(k) = enerinelasold(k)
   end do
end subroutine baseline_vumat_elastic

! J2 with linear isotropic hardening, the usual form. PROPS: E, nu, yield stress, H. State: eq. plastic strain
subroutine baseline_vumat_j2(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, &
   cmname, coordmp, charlength, props, density, straininc, relspininc, tempold, stretchold, &
   defgradold, fieldold, stressold, stateold, enerinternold, enerinelasold, tempnew, &
   stretchnew, defgradnew, fieldnew, stressnew, statenew, enerinternnew, enerinelasnew)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal
   real(real64), intent(in) :: steptime, totaltime, dt, coordmp(nblock, *), charlength(nblock), props(*), density(nblock)
   character(len=80), intent(in) :: cmname
   real(real64), intent(in) :: straininc(nblock, 6), relspininc(nblock, 3), tempold(nblock), stretchold(nblock, 6)
   real(real64), intent(in) :: defgradold(nblock, 9), fieldold(nblock, *), stressold(nblock, 6), stateold(nblock, *)
   real(real64), intent(in) :: enerinternold(nblock), enerinelasold(nblock), tempnew(nblock), stretchnew(nblock, 6)
   real(real64), intent(in) :: defgradnew(nblock, 9), fieldnew(nblock, *)
   real(real64), intent(inout) :: stressnew(nblock, 6), statenew(nblock, *), enerinternnew(nblock), enerinelasnew(nblock)
   real(real64) :: shear, bulk, lambda, volumetric, mean, s(6), q, flow, dp, beta, work, plastic
   integer :: k, i

   shear = props(1)/(2*(1 + props(2)))
   bulk = props(1)/(3*(1 - 2*props(2)))
   lambda = bulk - 2*shear/3
   do k = 1, nblock
      volumetric = lambda*(straininc(k, 1) + straininc(k, 2) + straininc(k, 3))
      do i = 1, 3
         s(i) = stressold(k, i) + volumetric + 2*shear*straininc(k, i)
         s(i + 3) = stressold(k, i + 3) + 2*shear*straininc(k, i + 3)
      end do
      mean = (s(1) + s(2) + s(3))/3
      s(1:3) = s(1:3) - mean
      q = sqrt(1.5_real64*(s(1)**2 + s(2)**2 + s(3)**2) + 3*(s(4)**2 + s(5)**2 + s(6)**2))
      flow = props(3) + props(4)*stateold(k, 1)
      dp = 0
      beta = 1
      if (q > flow) then
         dp = (q - flow)/(3*shear + props(4))
         beta = 1 - 3*shear*dp/q
      end if
      stressnew(k, 1:3) = beta*s(1:3) + mean
      stressnew(k, 4:6) = beta*s(4:6)
      statenew(k, 1) = stateold(k, 1) + dp
      work = 0
      do i = 1, 3
         work = work + 0.5_real64*(stressold(k, i) + stressnew(k, i))*straininc(k, i) &
                + (stressold(k, i + 3) + stressnew(k, i + 3))*straininc(k, i + 3)
      end do
      plastic = (flow + 0.5_real64*props(4)*dp)*dp
      enerinternnew(k) = enerinternold(k) + work/density(k)
      enerinelasnew(k) = enerinelasold(k) + plastic/density(k)
   end do
end subroutine baseline_vumat_j2

! J2 with linear isotropic hardening, hand-vectorised. PROPS: E, nu, yield stress, H. State: eq. plastic strain; with four
! state variables also, as ISO_PLASTIC, its rate, the flow stress and a thermal part of it, which is 0.
subroutine baseline_vumat_j2_simd(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, &
   cmname, coordmp, charlength, props, density, straininc, relspininc, tempold, stretchold, &
   defgradold, fieldold, stressold, stateold, enerinternold, enerinelasold, tempnew, &
   stretchnew, defgradnew, fieldnew, stressnew, statenew, enerinternnew, enerinelasnew)
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   integer, intent(in) :: nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal
   real(real64), intent(in) :: steptime, totaltime, dt, coordmp(nblock, *), charlength(nblock), props(*), density(nblock)
   character(len=80), intent(in) :: cmname
   real(real64), intent(in) :: straininc(nblock, 6), relspininc(nblock, 3), tempold(nblock), stretchold(nblock, 6)
   real(real64), intent(in) :: defgradold(nblock, 9), fieldold(nblock, *), stressold(nblock, 6), stateold(nblock, *)
   real(real64), intent(in) :: enerinternold(nblock), enerinelasold(nblock), tempnew(nblock), stretchnew(nblock, 6)
   real(real64), intent(in) :: defgradnew(nblock, 9), fieldnew(nblock, *)
   real(real64), intent(inout) :: stressnew(nblock, 6), statenew(nblock, *), enerinternnew(nblock), enerinelasnew(nblock)
   real(real64) :: shear2, shear3, lambda, hardening, compliance, volumetric, mean, s1, s2, s3, s4, s5, s6, q, flow, dp, beta
   real(real64) :: work, inverse_density, rate
   integer :: k

   shear2 = props(1)/(1 + props(2))
   shear3 = 1.5_real64*shear2
   lambda = shear2*props(2)/(1 - 2*props(2))
   hardening = props(4)
   compliance = 1/(shear3 + hardening)
   !$omp simd private(volumetric, mean, s1, s2, s3, s4, s5, s6, q, flow, dp, beta, work, inverse_density)
   do k = 1, nblock
      volumetric = lambda*(straininc(k, 1) + straininc(k, 2) + straininc(k, 3))
      s1 = stressold(k, 1) + volumetric + shear2*straininc(k, 1)
      s2 = stressold(k, 2) + volumetric + shear2*straininc(k, 2)
      s3 = stressold(k, 3) + volumetric + shear2*straininc(k, 3)
      s4 = stressold(k, 4) + shear2*straininc(k, 4)
      s5 = stressold(k, 5) + shear2*straininc(k, 5)
      s6 = stressold(k, 6) + shear2*straininc(k, 6)
      mean = (s1 + s2 + s3)*(1/3.0_real64)
      s1 = s1 - mean
      s2 = s2 - mean
      s3 = s3 - mean
      q = sqrt(1.5_real64*(s1**2 + s2**2 + s3**2) + 3*(s4**2 + s5**2 + s6**2))
      flow = props(3) + hardening*stateold(k, 1)
      dp = max(0.0_real64, q - flow)*compliance
      ! The tiny number keeps 0/0 away from an unstressed point.
      beta = 1 - shear3*dp/(q + tiny(q))
      s1 = beta*s1 + mean
      s2 = beta*s2 + mean
      s3 = beta*s3 + mean
      s4 = beta*s4
      s5 = beta*s5
      s6 = beta*s6
      work = 0.5_real64*((stressold(k, 1) + s1)*straininc(k, 1) + (stressold(k, 2) + s2)*straininc(k, 2) &
                         + (stressold(k, 3) + s3)*straininc(k, 3)) + (stressold(k, 4) + s4)*straininc(k, 4) &
             + (stressold(k, 5) + s5)*straininc(k, 5) + (stressold(k, 6) + s6)*straininc(k, 6)
      stressnew(k, 1) = s1
      stressnew(k, 2) = s2
      stressnew(k, 3) = s3
      stressnew(k, 4) = s4
      stressnew(k, 5) = s5
      stressnew(k, 6) = s6
      statenew(k, 1) = stateold(k, 1) + dp
      inverse_density = 1/density(k)
      enerinternnew(k) = enerinternold(k) + work*inverse_density
      enerinelasnew(k) = enerinelasold(k) + (flow + 0.5_real64*hardening*dp)*dp*inverse_density
   end do
   if (nstatev < 4) return
   rate = 1/dt
   !$omp simd
   do k = 1, nblock
      statenew(k, 2) = (statenew(k, 1) - stateold(k, 1))*rate
      statenew(k, 3) = props(3) + hardening*statenew(k, 1)
      statenew(k, 4) = 0
   end do
end subroutine baseline_vumat_j2_simd
