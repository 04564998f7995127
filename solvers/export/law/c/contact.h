/* A contact that a host interrupts: begun at initial contact, advanced to a time, read, and advanced again. */

int law_advance(law_contact *c, double t)
{
    if (!(t >= c->time && t < HUGE_VAL))
        return LAW_BAD_TIME;
    if (c->motion == LAW_APART || c->motion == LAW_CUT_OFF || c->motion == LAW_LOST)
        return c->status;
    if (c->impact.angle > 0.0 || c->impact.spin != 0.0 || c->impact.partner_spin != 0.0)
        @{booked}plane_follow(c, t);
    else
        @{booked}head_on_follow(c, t);
    return c->status;
}

int law_begin(const law_material *material, const law_impact *impact, double rtol, int budget, law_contact *c)
{
    memset(c, 0, sizeof *c);
    c->material = *material;
    c->impact = *impact;
    c->rtol = rtol;
    c->budget = budget;
    c->status = check_material(material);
    if (c->status == LAW_OK)
        c->status = check_settings(rtol, budget);
    if (c->status == LAW_OK)
        c->status = check_impact(impact);
    if (c->status == LAW_OK)
        return law_advance(c, 0.0);
    c->motion = LAW_LOST;
    c->outcome = LAW_UNDECIDED;
    return c->status;
}

