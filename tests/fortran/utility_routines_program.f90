! The utility routines called the way Fortran user subroutines call them: implicit interfaces, CHARACTER arguments with
! hidden lengths.
program utility_routines_program
   use, intrinsic :: iso_fortran_env, only: real64, error_unit
   implicit none
   external :: sinv, sprinc, sprind, rotsig, stdb_abqerr, xit, getjobname, getoutdir, getrank, getnumcpus
   external :: mutexinit, mutexlock, mutexunlock, vsprinc
   integer, external :: get_thread_id, getnumthreads
   real(real64) :: s(6), ps(3), an(3, 3), turned(6), r(3, 3), mean, mises, eigval(2, 3)
   integer :: length, rank, processes, thread, threads
   character(len=256) :: name
   character(len=8) :: words(2)

   s = [120.0_real64, 40.0_real64, -10.0_real64, 30.0_real64, 0.0_real64, 0.0_real64]
   call sinv(s, mean, mises, 3, 3)
   call expect(mean, 50.0_real64, 'SINV mean')
   call expect(mises, sqrt(0.5_real64*(80.0_real64**2 + 50.0_real64**2 + 130.0_real64**2) + 2700), 'SINV Mises')

   call sprinc(s, ps, 1, 3, 3)
   call expect(ps(1), 130.0_real64, 'SPRINC 1')
   call expect(ps(2), 30.0_real64, 'SPRINC 2')
   call expect(ps(3), -10.0_real64, 'SPRINC 3')

   call sprind(s, ps, an, 1, 3, 3)
   call expect(abs(an(1, 1)), 3/sqrt(10.0_real64), 'SPRIND direction 1, x')
   call expect(abs(an(1, 2)), 1/sqrt(10.0_real64), 'SPRIND direction 1, y')
   call expect(abs(an(3, 3)), 1.0_real64, 'SPRIND direction 3, z')

   r = reshape([0, 1, 0, -1, 0, 0, 0, 0, 1]*1.0_real64, [3, 3])
   call rotsig(s, r, turned, 1, 3, 3)
   call expect(turned(1), 40.0_real64, 'ROTSIG 11')
   call expect(turned(2), 120.0_real64, 'ROTSIG 22')
   call expect(turned(4), -30.0_real64, 'ROTSIG 12')

   call vsprinc(2, reshape([3, 1, 2, 1, 1, 1, 0, 0, 0, 0, 0, 0]*1.0_real64, [2, 6]), eigval, 3, 3)
   call expect(eigval(1, 1), 3.0_real64, 'VSPRINC 1')
   call expect(eigval(1, 3), 1.0_real64, 'VSPRINC 3')
   call expect(eigval(2, 2), 1.0_real64, 'VSPRINC second point')

   call getjobname(name, length)
   if (name(1:length) /= 'lode' .or. name(length + 1:) /= ' ') call fail('GETJOBNAME')
   call getoutdir(name, length)
   if (length < 1 .or. name(1:1) /= '/') call fail('GETOUTDIR')
   call getrank(rank)
   call getnumcpus(processes)
   if (rank /= 0 .or. processes /= 1) call fail('GETRANK, GETNUMCPUS')
   thread = get_thread_id()
   threads = getnumthreads()
   if (thread /= 0 .or. threads /= 1) call fail('thread numbers')
   call mutexinit(1)
   call mutexlock(1)
   call mutexunlock(1)

   words = [character(len=8) :: 'first', 'second']
   call stdb_abqerr(-1, 'words %S and %S, numbers %I and %R', [42], [0.25_real64], words)
   print '(a)', 'all utility routines agree'
   call xit

contains

   subroutine expect(value, expected, what)
      real(real64), intent(in) :: value, expected
      character(len=*), intent(in) :: what

      if (.not. abs(value - expected) <= 1e-13_real64*(1 + abs(expected))) then
         write (error_unit, *) what, value, expected
         call fail(what)
      end if
   end subroutine expect

   subroutine fail(what)
      character(len=*), intent(in) :: what

      write (error_unit, *) 'FAILED: ', what
      stop 1
   end subroutine fail
end program utility_routines_program
