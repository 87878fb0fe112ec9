! A user material in Fortran with the mistakes that such materials have: the build defines one of the names below, or
! none for the correct twin. Von Mises plasticity with linear kinematic (Prager) hardening, 3D and plane strain.
!   PROPS E, nu, yield stress, kinematic modulus C      STATEV back stress (NTENS), equivalent plastic strain
SUBROUTINE UMAT(STRESS, STATEV, DDSDDE, SSE, SPD, SCD, RPL, DDSDDT, DRPLDE, DRPLDT, STRAN, DSTRAN, TIME, DTIME, TEMP, &
                DTEMP, PREDEF, DPRED, CMNAME, NDI, NSHR, NTENS, NSTATV, PROPS, NPROPS, COORDS, DROT, PNEWDT, CELENT, &
                DFGRD0, DFGRD1, NOEL, NPT, LAYER, KSPT, JSTEP, KINC)
  IMPLICIT NONE
  CHARACTER(LEN=80) :: CMNAME
  INTEGER :: NDI, NSHR, NTENS, NSTATV, NPROPS, NOEL, NPT, LAYER, KSPT, JSTEP(4), KINC
  DOUBLE PRECISION :: STRESS(NTENS), STATEV(*), DDSDDE(NTENS, NTENS), SSE, SPD, SCD, RPL, DDSDDT(NTENS), &
                      DRPLDE(NTENS), DRPLDT, STRAN(NTENS), DSTRAN(NTENS), TIME(2), DTIME, TEMP, DTEMP, PREDEF(*), &
                      DPRED(*), PROPS(*), COORDS(3), DROT(3, 3), PNEWDT, CELENT, DFGRD0(3, 3), DFGRD1(3, 3)
  DOUBLE PRECISION :: G, LAMBDA, YIELD, C, BACK(6), XI(6), OLD(6), TRIAL(6), Q, DP, RATIO, MEAN, N(6), LARGEST
  INTEGER :: I, J
#ifdef ZOO_DDSDDE_UNSET
  DOUBLE PRECISION :: UNTOUCHED
#endif
#ifdef ZOO_SAVE_VARIABLE
  DOUBLE PRECISION, SAVE :: PLASTIC = 0.D0
#endif

  IF (NPROPS < 4 .OR. NSTATV < NTENS + 1) CALL XIT
  G = PROPS(1)/(2.D0*(1.D0 + PROPS(2)))
  LAMBDA = PROPS(1)*PROPS(2)/((1.D0 + PROPS(2))*(1.D0 - 2.D0*PROPS(2)))
  YIELD = PROPS(3)
  C = PROPS(4)
#ifdef ZOO_READS_PROPS_BEYOND
  YIELD = YIELD + 1.D-80*PROPS(NPROPS + 1)
#endif
#ifdef ZOO_SAVE_VARIABLE
  YIELD = YIELD*(1.D0 + PLASTIC)
#endif
#ifdef ZOO_STOP_ON_NAN
  IF (DSTRAN(1) /= DSTRAN(1)) STOP 'NaN in DSTRAN'
#endif
#ifdef ZOO_WRITES_DSTRAN
  DSTRAN = DSTRAN*(1.D0 + 1.D-12)
#endif
  LARGEST = 0.D0
  DO I = 1, NTENS
    LARGEST = MAX(LARGEST, ABS(DSTRAN(I)))
    IF (DSTRAN(I) /= DSTRAN(I)) LARGEST = 2.D0
  END DO
  ! What is far too large, or no number, is not for this material.
  IF (LARGEST > 1.D0) THEN
    PNEWDT = 0.25D0
    RETURN
  END IF

#ifdef ZOO_STRESS_ROTATED
  CALL ROTSIG(STRESS, DROT, OLD, 1, NDI, NSHR)
  STRESS = OLD(1:NTENS)
#endif
#ifdef ZOO_STATE_NOT_ROTATED
  BACK(1:NTENS) = STATEV(1:NTENS)
#else
  CALL ROTSIG(STATEV, DROT, BACK, 1, NDI, NSHR)
#endif

#ifdef ZOO_DDSDDE_UNSET
  UNTOUCHED = DDSDDE(NTENS, 1)
#endif
  DDSDDE = 0.D0
  DDSDDE(1:NDI, 1:NDI) = LAMBDA
  DO I = 1, NDI
    DDSDDE(I, I) = LAMBDA + 2.D0*G
  END DO
  DO I = NDI + 1, NTENS
    DDSDDE(I, I) = G
  END DO

  OLD(1:NTENS) = STRESS
  TRIAL(1:NTENS) = STRESS + MATMUL(DDSDDE, DSTRAN)
  XI(1:NTENS) = TRIAL(1:NTENS) - BACK(1:NTENS)
  MEAN = SUM(XI(1:NDI))/3.D0
  XI(1:NDI) = XI(1:NDI) - MEAN
  Q = SQRT(1.5D0*(SUM(XI(1:NDI)**2) + 2.D0*SUM(XI(NDI + 1:NTENS)**2)))
  DP = 0.D0
  IF (Q > YIELD) THEN
    DP = (Q - YIELD)/(3.D0*G + C)
    RATIO = 1.D0 - 3.D0*G*DP/Q
    N(1:NTENS) = XI(1:NTENS)/Q
    TRIAL(1:NTENS) = TRIAL(1:NTENS) - 3.D0*G*DP*N(1:NTENS)
    BACK(1:NTENS) = BACK(1:NTENS) + C*DP*N(1:NTENS)
#ifndef ZOO_TANGENT_ELASTIC
    DO J = 1, NTENS
      DO I = 1, NTENS
        IF (I <= NDI .AND. J <= NDI) THEN
          DDSDDE(I, J) = LAMBDA + 2.D0*G/3.D0*(1.D0 - RATIO)
          IF (I == J) DDSDDE(I, J) = DDSDDE(I, J) + 2.D0*G*RATIO
        ELSE IF (I == J) THEN
          DDSDDE(I, J) = G*RATIO
        END IF
        DDSDDE(I, J) = DDSDDE(I, J) - 9.D0*G*G*(1.D0/(3.D0*G + C) - DP/Q)*N(I)*N(J)
      END DO
    END DO
#endif
  END IF
#ifdef ZOO_TANGENT_SHEAR
  DDSDDE(:, NDI + 1:NTENS) = 2.D0*DDSDDE(:, NDI + 1:NTENS)
#endif
#ifdef ZOO_SAVE_VARIABLE
  PLASTIC = PLASTIC + DP
#endif

  STRESS = TRIAL(1:NTENS)
  STATEV(1:NTENS) = BACK(1:NTENS)
#ifdef ZOO_STATEV_BEYOND
  STATEV(NSTATV + 1) = Q
#endif
  STATEV(NTENS + 1) = STATEV(NTENS + 1) + DP
#ifndef ZOO_ENERGY_NOT_SET
  ! Stored: the elastic part and that of the back stress, b:b 3/(4 C), which only heals on reversal.
  MEAN = SUM(STRESS(1:NDI))/3.D0
  SSE = MEAN**2/(2.D0*(LAMBDA + 2.D0*G/3.D0))
  SSE = SSE + (SUM((STRESS(1:NDI) - MEAN)**2) + 2.D0*SUM(STRESS(NDI + 1:NTENS)**2))/(4.D0*G)
  SSE = SSE + 0.75D0/C*(SUM(BACK(1:NDI)**2) + 2.D0*SUM(BACK(NDI + 1:NTENS)**2))
  SPD = SPD + YIELD*DP
#endif
#ifdef ZOO_NAN_ON_ZERO
  STRESS = STRESS*(SUM(ABS(DSTRAN))/SUM(ABS(DSTRAN)))
#endif
#ifdef ZOO_DDSDDE_UNSET
  DDSDDE(NTENS, 1) = UNTOUCHED
#endif
#ifdef ZOO_ABOVE_ONE
  PNEWDT = 1.5D0
#endif
END SUBROUTINE UMAT
