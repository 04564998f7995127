/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* How the groups change with a quantity in SI. */
static inline void scale_along(const constants *v, const vec *q, int quantity, vec *slope)
{
    (void)v; (void)q;
    memset(slope, 0, sizeof(vec)*GROUPS);
    switch (quantity) {
    case SI_REDUCED_RADIUS:
        slope[BY_STOKES] = -2.0*v->stokes/q[SI_REDUCED_RADIUS];
        slope[BY_ASPECT] = -v->aspect/q[SI_REDUCED_RADIUS];
        slope[BY_INITIAL_SPIN] = v->initial_spin/q[SI_REDUCED_RADIUS];
        slope[BY_CAPILLARY] = v->capillary/q[SI_REDUCED_RADIUS];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_REDUCED_RADIUS];
        slope[BY_ELASTIC_GAP] = 0.6*v->elastic_gap/q[SI_REDUCED_RADIUS];
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] = v->rupture_gap/q[SI_REDUCED_RADIUS];
#else
        slope[BY_RUPTURE_GAP] = v->rupture_gap/q[SI_REDUCED_RADIUS];
#endif
        break;
    case SI_REDUCED_MASS:
        slope[BY_STOKES] = v->stokes/q[SI_REDUCED_MASS];
        break;
    case SI_ROUGHNESS:
        slope[BY_ROUGH_GAP] = v->rough_gap/q[SI_ROUGHNESS];
        break;
    case SI_DRY_RESTITUTION:
        slope[BY_DRY_RESTITUTION] = splat(1.0);
        break;
    case SI_YOUNGS_MODULUS:
        slope[BY_ELASTIC_GAP] = -0.4*v->elastic_gap/q[SI_YOUNGS_MODULUS];
        break;
    case SI_POISSON_RATIO:
        slope[BY_ELASTIC_GAP] =
        -0.8*1.148698354997035*1.5518455739153596*q[SI_POISSON_RATIO]*vec_exp(0.6*vec_log(q[SI_REDUCED_RADIUS]/(1.0
        -
        (q[SI_POISSON_RATIO]*q[SI_POISSON_RATIO]))))*vec_exp(0.4*vec_log(q[SI_SPEED]*q[SI_VISCOSITY]/q[SI_YOUNGS_MODULUS]))/q[SI_FILM_THICKNESS];
        break;
    case SI_VISCOSITY:
        slope[BY_STOKES] = -v->stokes/q[SI_VISCOSITY];
        slope[BY_CAPILLARY] = v->capillary/q[SI_VISCOSITY];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_VISCOSITY];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_VISCOSITY];
        break;
    case SI_FILM_THICKNESS:
        slope[BY_ASPECT] = v->aspect/q[SI_FILM_THICKNESS];
        slope[BY_CAPILLARY] = -v->capillary/q[SI_FILM_THICKNESS];
        slope[BY_GLASS_NUMBER] = 2.0*v->glass_number/q[SI_FILM_THICKNESS];
        slope[BY_ELASTIC_GAP] = -v->elastic_gap/q[SI_FILM_THICKNESS];
        slope[BY_ROUGH_GAP] = -v->rough_gap/q[SI_FILM_THICKNESS];
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] = -v->rupture_gap/q[SI_FILM_THICKNESS];
#else
        slope[BY_RUPTURE_GAP] = -v->rupture_gap/q[SI_FILM_THICKNESS];
#endif
        break;
    case SI_GLASS_TRANSITION_PRESSURE:
        slope[BY_GLASS_NUMBER] = v->glass_number/q[SI_GLASS_TRANSITION_PRESSURE];
        break;
    case SI_SURFACE_TENSION:
        slope[BY_CAPILLARY] = -v->capillary/q[SI_SURFACE_TENSION];
        break;
    case SI_SPEED:
        slope[BY_STOKES] = v->stokes/q[SI_SPEED];
        slope[BY_INITIAL_SPIN] = -v->initial_spin/q[SI_SPEED];
        slope[BY_CAPILLARY] = v->capillary/q[SI_SPEED];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_SPEED];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_SPEED];
        break;
    case SI_ANGLE:
        slope[BY_INITIAL_TURNING] = ((vec_tan(q[SI_ANGLE])*vec_tan(q[SI_ANGLE])) + 1.0)/v->obliquity;
        break;
    case SI_IMPACT_SPIN:
        slope[BY_INITIAL_SPIN] = 4.0*q[SI_REDUCED_RADIUS]/(v->obliquity*q[SI_SPEED]);
        break;
    case SI_VOLUME:
        slope[BY_VOLUME] = splat(1.0);
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] = 2.0*q[SI_REDUCED_RADIUS]*bridge_rupture_distance_by_volume(q[SI_VOLUME],
        q[SI_CONTACT_ANGLE])/q[SI_FILM_THICKNESS];
#else
        slope[BY_RUPTURE_GAP] = 0.3333333333333333*v->rupture_gap/q[SI_VOLUME];
#endif
        break;
    case SI_CONTACT_ANGLE:
        slope[BY_CONTACT_ANGLE] = splat(1.0);
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] =
        2.0*q[SI_REDUCED_RADIUS]*bridge_rupture_distance_by_contact_angle(q[SI_VOLUME],
        q[SI_CONTACT_ANGLE])/q[SI_FILM_THICKNESS];
#else
        slope[BY_RUPTURE_GAP] =
        q[SI_REDUCED_RADIUS]*vec_exp(0.3333333333333333*vec_log(q[SI_VOLUME]))/q[SI_FILM_THICKNESS];
#endif
        break;
    }
}
