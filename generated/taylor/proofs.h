/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Stick certificates sha256 9f880495be355849ea920e9a0479dd9c3e0c742e55a349ff54e8c9db75e6d7a7
 *
 * Inequalities of stick certificates. Included where `vec` and `mask` are known. */

/* Lanes in which the energy is below a barrier, lowered by what a drift of L may do. */
static inline mask is_below_barrier(vec energy, vec height, double margin, vec largest, vec drift)
{
    return (energy < height - margin*(largest + vec_abs(height)) - drift);
}

/* Lanes in which a doublet that tumbles as one body is held with all momentum across the line of centres. */
static inline mask tumbles_for_good(vec rest, vec rigid, vec work, vec height, double margin, vec largest)
{
    return ((rest < TUMBLES*rigid) & (rest + rigid + work < height - margin*(largest + vec_abs(height))));
}

/* Lanes in which the film takes more than what drives a motion. */
static inline mask is_stopped(vec excess, vec error)
{
    return (excess + error < 0);
}

/* Lanes in which the reaction stays inward at the largest momentum that slip allows. */
static inline mask rests_for_good(vec reaction, double margin, vec largest)
{
    return (reaction > margin*largest);
}

/* Lanes in which all forces but that of the film point inward. */
static inline mask points_inward(vec outward, vec pull, double margin)
{
    return (outward - pull + margin*(outward + pull) < 0);
}

/* Lanes in which the attraction lets no maximum of the gap exceed the one before. */
static inline mask attraction_holds(vec gap, vec contact, double margin, vec hold, vec rebound, vec escape,
    vec energy)
{
    return ((gap >= contact*(1 - margin)) & (hold > 0) & (rebound < -margin*hold) & (escape <
        -margin*energy));
}

/* Lanes in which the energy does not suffice for a gap ahead. */
static inline mask stays_below(vec needed, double margin, vec size)
{
    return (needed < -margin*size);
}

/* Lanes in which without angular momentum, or without orbital momentum, the film keeps the doublet. */
static inline mask spins_down(vec gap, vec contact, double margin, vec momentum, vec rate, vec stays, vec
    error, vec orbital_momentum, vec inside, vec apart)
{
    return ((gap >= contact*(1 - margin)) & (((momentum <= 0) & (rate > 0) & (stays < -error)) |
        ((orbital_momentum == 0) & (inside < 0) & (apart < -error))));
}

/* Lanes in which a rebound loses more than the rotation gives on the way back to the maximum. */
static inline mask comes_back(vec outward, vec lost, double margin)
{
    return (outward < lost*(1 - margin));
}
