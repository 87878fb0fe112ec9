/* The C side of Lode: how a model describes itself, and the functions that list the models of a loaded library.
 *
 * Every model carries one `lode_model` constant. Validation, error messages, `lode models`, the reference pages, the
 * property suite and the benchmarks all read that constant, so PROPS and STATEV are written down exactly once.
 * All strings are NUL-terminated and live as long as the library is loaded. */
#ifndef LODE_H
#define LODE_H

#if defined(__GNUC__)
#define LODE_API __attribute__((visibility("default")))
#else
#define LODE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Bits of lode_model.kinds, one for each analysis kind (NDI, NSHR). */
enum {
    LODE_SOLID = 1,        /* (3,3) three-dimensional                         */
    LODE_PLANE_STRAIN = 2, /* (3,1) plane strain and axisymmetric             */
    LODE_PLANE_STRESS = 4, /* (2,1); VUMAT: (3,1) with a label `PS` or `PS-*` */
    LODE_UNIAXIAL = 8,     /* (1,0)                                           */
    LODE_COHESIVE_2D = 16, /* (1,1) traction-separation, normal first         */
    LODE_COHESIVE_3D = 32  /* (1,2)                                           */
};

/* Bits of lode_parameter.flags. */
enum {
    LODE_LOWER_OPEN = 1,      /* the lower limit itself is not allowed               */
    LODE_UPPER_OPEN = 2,      /* the upper limit itself is not allowed               */
    LODE_INTEGER = 4,         /* a code or a count                                   */
    LODE_ZERO_IS_DEFAULT = 8, /* an entry of 0 means the default, like a missing one */
    LODE_OPTIONAL = 16,       /* has a default                                       */
    /* From this bit on: 0, or the number in the table of the count that says how often the entry stands in PROPS.
     * Neighbours with the same count alternate, G1, tau1, G2, tau2, ..., and what follows them moves on. */
    LODE_REPEATED_SHIFT = 8
};

/* Bits of lode_model.traits. */
enum {
    LODE_FINITE_STRAIN = 1,      /* reads the deformation gradient and ignores DSTRAN     */
    LODE_UNSYMMETRIC = 2,        /* DDSDDE is not symmetric: ask the host for that solver */
    LODE_ROTATES_STATE = 4,      /* tensor-valued STATEV is rotated with DROT             */
    LODE_USES_CELENT = 8,        /* softening is regularised by the element length        */
    LODE_ELASTIC = 16,           /* no history: energy is recovered on any closed path    */
    LODE_HISTORY_STRESS = 32,    /* STRESS on entry is ignored, stress follows from STATEV or F */
    LODE_EQUATION_OF_STATE = 64, /* p(V, T) of absolute TEMP; SSE is internal energy, which heat changes too */
    LODE_VISCOUS = 128,          /* part of the stress is proportional to DSTRAN/DTIME and goes with it */
    LODE_OPEN_ENERGY = 256,      /* the work of phase changes is in none of SSE, SPD, SCD */
    LODE_FRAME_CHOICE = 512,     /* the onset of damage picks one of several equivalent directions by the axes */
    LODE_ENERGY_ESTIMATE = 1024, /* SSE and SCD are estimates: they balance the work at small strain only */
    LODE_ITERATES = 2048         /* equations are solved by iteration, in some kind and for some constants */
};

typedef struct lode_parameter {
    const char* symbol;   /* as on the model's page, e.g. "NU"          */
    const char* name;     /* what it is, e.g. "Poisson's ratio"         */
    const char* unit;     /* "-" if it has none                         */
    double lower, upper;  /* +-HUGE_VAL where there is no limit         */
    double default_value; /* meaningful with LODE_OPTIONAL              */
    unsigned flags;
    const char* note; /* one sentence more, or ""                   */
} lode_parameter;

typedef struct lode_state {
    const char* name; /* e.g. "EQPS"                                */
    const char* meaning;
    double initial;
} lode_state;

/* A set of constants that is ready to use: printed as cards, run by the property suite and the benchmarks. */
typedef struct lode_sample {
    const char* label;   /* e.g. "STEEL"; the card reads KEYWORD-LABEL */
    const char* meaning; /* what it is and in which units              */
    const double* constants;
    int constant_count;
    double strain_scale; /* a strain (cohesive: a separation) at which the model shows what it is for */
    unsigned kinds;      /* the kinds this sample makes sense in       */
} lode_sample;

/* An integration algorithm that a PROPS entry selects. */
typedef struct lode_algorithm {
    const char* name;
    int parameter; /* number in the table (1-based) of the entry that selects it, 0 if there is nothing to select */
    double value;  /* the value of that entry                    */
    double order;  /* convergence order in the increment on a non-proportional path; HUGE_VAL if exact */
} lode_algorithm;

typedef struct lode_model {
    const char* keyword; /* e.g. "ISO_PLASTIC"                         */
    const char* title;
    const char* family;  /* folder under core/                         */
    const char* purpose; /* a sentence or two for the reference page   */
    const char* source;  /* chapter and equations of the source text   */
    unsigned kinds, traits;
    const lode_parameter* parameters;
    int parameter_count, required_count;
    const lode_state* state;
    int state_count; /* entries described                          */
    const lode_sample* samples;
    int sample_count;
    const lode_algorithm* algorithms;
    int algorithm_count;
    const char* limits; /* where the model fails and what it then does; Markdown list */
} lode_model;

/* What the solution of one call took (`lode_umat_observed` in entry_points.h). A model in closed form, or a state that
 * asks for no solution, leaves zeros. Solves inside the residual of another one are part of its evaluation. */
typedef struct lode_observation {
    int iterations; /* evaluations of the residuals that are solved for their roots, summed over substeps       */
    int safeguards; /* steps between them by a bracket, a line search or a fallback in place of Newton's        */
    int substeps;   /* into which the model cut the increment, tried ones included; 0 if it was done in one     */
} lode_observation;

/* Number of models in this library. */
LODE_API int lode_model_count(void);
/* Model `index` (0-based) or NULL. */
LODE_API const lode_model* lode_model_at(int index);
/* STATEV entries that the material needs in the kind (NDI, NSHR); -1 with a message in `error` (may be NULL) if the
 * constants are refused or the kind is not served. `name` is the material name, e.g. "ISO_PLASTIC-STEEL". */
LODE_API int lode_required_state(const char* name, const double* constants, int constant_count, int ndi, int nshr,
                                 char* error, int error_size);
/* "0.1.0", and the instruction set of the kernels that were picked on this machine, e.g. "x86-64-v4". */
LODE_API const char* lode_version(void);
LODE_API const char* lode_instruction_set(void);

#ifdef __cplusplus
}
#endif
#endif
