/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* The groups of a collision from its quantities in SI. */
static inline void scale(constants *c, const vec *q)
{
    c->stokes =
        0.16666666666666666*q[SI_REDUCED_MASS]*q[SI_SPEED]/(3.141592653589793*(q[SI_REDUCED_RADIUS]*q[SI_REDUCED_RADIUS])*q[SI_VISCOSITY]);
    c->aspect = q[SI_FILM_THICKNESS]/q[SI_REDUCED_RADIUS];
    c->obliquity = vec_larger(vec_tan(q[SI_ANGLE]),
        2.0*q[SI_REDUCED_RADIUS]*vec_abs(q[SI_IMPACT_SPIN])/q[SI_SPEED]);
    c->initial_turning = vec_tan(q[SI_ANGLE])/c->obliquity;
    c->initial_spin = 4.0*q[SI_IMPACT_SPIN]*q[SI_REDUCED_RADIUS]/(c->obliquity*q[SI_SPEED]);
    c->glass_number =
        0.3333333333333333*(q[SI_FILM_THICKNESS]*q[SI_FILM_THICKNESS])*q[SI_GLASS_TRANSITION_PRESSURE]/(q[SI_REDUCED_RADIUS]*q[SI_SPEED]*q[SI_VISCOSITY]);
    c->elastic_gap =
        1.148698354997035*1.5518455739153596*vec_exp(0.6*vec_log(q[SI_REDUCED_RADIUS]))*vec_exp(0.4*vec_log(q[SI_SPEED]*q[SI_VISCOSITY]*(1.0
        - (q[SI_POISSON_RATIO]*q[SI_POISSON_RATIO]))/q[SI_YOUNGS_MODULUS]))/q[SI_FILM_THICKNESS];
    c->rough_gap = q[SI_ROUGHNESS]/q[SI_FILM_THICKNESS];
    c->dry_restitution = q[SI_DRY_RESTITUTION];
}
