! Explicit interfaces to the entry points of a UMAT/VUMAT library, so that the compiler checks a Fortran host's calls.
!
!   use lode_interfaces          UMAT, and VUMAT with double precision reals
!   use lode_interfaces_single   VUMAT with single precision reals, for a library built for single-precision hosts
!
! Both VUMATs are the same external symbol, vumat_: a program links to one library or the other.
! The hidden length of CMNAME follows all other arguments by value; the compiler passes it.
module lode_interfaces
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   private
   public :: umat, vumat

   interface
      subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                      temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, &
                      pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
         import :: real64
         implicit none
         integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops
         real(real64), intent(inout) :: stress(ntens)          ! Cauchy stress, start of increment -> end
         real(real64), intent(inout) :: statev(nstatv)
         real(real64), intent(inout) :: ddsdde(ntens, ntens)
         real(real64), intent(inout) :: sse, spd, scd          ! elastic, plastic, creep energy per volume
         real(real64), intent(inout) :: rpl, ddsddt(ntens), drplde(ntens), drpldt
         real(real64), intent(in) :: stran(ntens), dstran(ntens)   ! 11, 22, 33, 12, 13, 23, engineering shears
         real(real64), intent(in) :: time(2)                   ! step time, total time at the start
         real(real64), intent(in) :: dtime
         real(real64), intent(in) :: temp, dtemp
         real(real64), intent(in) :: predef(*), dpred(*)
         character(len=80), intent(in) :: cmname
         real(real64), intent(in) :: props(nprops)
         real(real64), intent(in) :: coords(3), drot(3, 3)
         real(real64), intent(inout) :: pnewdt
         real(real64), intent(in) :: celent
         real(real64), intent(in) :: dfgrd0(3, 3), dfgrd1(3, 3)
         integer, intent(in) :: noel, npt, layer, kspt, jstep(4), kinc
      end subroutine umat

      subroutine vumat(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, cmname, &
                       coordmp, charlength, props, density, straininc, relspininc, tempold, stretchold, defgradold, &
                       fieldold, stressold, stateold, enerinternold, enerinelasold, tempnew, stretchnew, defgradnew, &
                       fieldnew, stressnew, statenew, enerinternnew, enerinelasnew)
         import :: real64
         implicit none
         integer, intent(in) :: nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal
         real(real64), intent(in) :: steptime, totaltime, dt
         character(len=80), intent(in) :: cmname
         real(real64), intent(in) :: coordmp(nblock, *), charlength(nblock), props(nprops), density(nblock)
         real(real64), intent(inout) :: straininc(nblock, ndir + nshr)   ! 11, 22, 33, 12, 23, 31, tensor shears
         real(real64), intent(in) :: relspininc(nblock, nshr), tempold(nblock)
         real(real64), intent(in) :: stretchold(nblock, ndir + nshr), defgradold(nblock, ndir + 2*nshr)
         real(real64), intent(in) :: fieldold(nblock, nfieldv), stressold(nblock, ndir + nshr)
         real(real64), intent(in) :: stateold(nblock, nstatev), enerinternold(nblock), enerinelasold(nblock)
         real(real64), intent(in) :: tempnew(nblock)
         real(real64), intent(in) :: stretchnew(nblock, ndir + nshr), defgradnew(nblock, ndir + 2*nshr)
         real(real64), intent(in) :: fieldnew(nblock, nfieldv)
         real(real64), intent(inout) :: stressnew(nblock, ndir + nshr), statenew(nblock, nstatev)
         real(real64), intent(inout) :: enerinternnew(nblock), enerinelasnew(nblock)   ! per unit mass
      end subroutine vumat
   end interface
end module lode_interfaces

module lode_interfaces_single
   use, intrinsic :: iso_fortran_env, only: real32
   implicit none
   private
   public :: vumat

   interface
      subroutine vumat(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, cmname, &
                       coordmp, charlength, props, density, straininc, relspininc, tempold, stretchold, defgradold, &
                       fieldold, stressold, stateold, enerinternold, enerinelasold, tempnew, stretchnew, defgradnew, &
                       fieldnew, stressnew, statenew, enerinternnew, enerinelasnew)
         import :: real32
         implicit none
         integer, intent(in) :: nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal
         real(real32), intent(in) :: steptime, totaltime, dt
         character(len=80), intent(in) :: cmname
         real(real32), intent(in) :: coordmp(nblock, *), charlength(nblock), props(nprops), density(nblock)
         real(real32), intent(inout) :: straininc(nblock, ndir + nshr)
         real(real32), intent(in) :: relspininc(nblock, nshr), tempold(nblock)
         real(real32), intent(in) :: stretchold(nblock, ndir + nshr), defgradold(nblock, ndir + 2*nshr)
         real(real32), intent(in) :: fieldold(nblock, nfieldv), stressold(nblock, ndir + nshr)
         real(real32), intent(in) :: stateold(nblock, nstatev), enerinternold(nblock), enerinelasold(nblock)
         real(real32), intent(in) :: tempnew(nblock)
         real(real32), intent(in) :: stretchnew(nblock, ndir + nshr), defgradnew(nblock, ndir + 2*nshr)
         real(real32), intent(in) :: fieldnew(nblock, nfieldv)
         real(real32), intent(inout) :: stressnew(nblock, ndir + nshr), statenew(nblock, nstatev)
         real(real32), intent(inout) :: enerinternnew(nblock), enerinelasnew(nblock)
      end subroutine vumat
   end interface
end module lode_interfaces_single
