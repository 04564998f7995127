"""What every table, entry and choice of a scene means: a sentence each in Markdown, for the documentation."""

TABLES = {
    "particles": "Two equal spheres, or the first of a pair. Required.",
    "partner": "Another sphere, or a wall, in place of an equal sphere. The sphere of `[particles]` is then the first "
    "of the pair, with its own radius and mass. Roughness, restitution, elastic constants and film are those of the "
    "contact.",
    "liquid": "The film on the spheres. Required.",
    "bridge": "The liquid bridge. Without this table there is no capillary force: the pair separates where the films "
    "part, and $Ce$ and $Ca$ do not exist.",
    "attraction": "Van der Waals attraction, with or without a bridge. It is neither retarded nor cut off at atomic "
    "distances, so the solids must keep the gap open: a roughness above 0, or elastic constants.",
    "pendulum": "The spheres hang on strings from pivots one diameter apart. Such a collision ends, as a stick, when "
    "the doublet has made half a turn or the strings turn its rotation back.",
    "model": "Variants of the equations that the paper leaves open. The first choice of each is the default.",
    "impact": "Initial contact of the films. It may be left to the command line.",
}
"""Table -> what it describes."""

ENTRIES = {
    "particles.reduced_radius": "reduced radius $a = R/2$ of either sphere",
    "particles.radius": "radius $R$ of one sphere",
    "particles.diameter": "diameter $2R$ of one sphere",
    "particles.reduced_mass": "reduced mass $m = M/2$ of either sphere",
    "particles.mass": "mass $M$ of one sphere",
    "particles.density": "density of the spheres; the mass follows from it",
    "particles.roughness": "$x_b$, the gap at which the asperities of the surfaces touch",
    "particles.dry_restitution": "$e_{dry}$, normal restitution of the dry spheres",
    "particles.friction": r"$\mu_f$, Coulomb coefficient of the dry contact; without it the contact has no friction",
    "particles.contact_tangential_restitution": r"$\beta_0$ of a dry contact that sticks: the slip is reversed, "
    r"$v_s' = -\beta_0 v_s$ (Walton & Braun 1986, *J. Rheol.* 30, 949); goes with `friction`, 0 without it",
    "particles.youngs_modulus": "$E$ of the spheres; without it there is no elastic criterion",
    "particles.poisson_ratio": r"$\nu$ of the spheres; goes with `youngs_modulus`",
    "liquid.viscosity": r"viscosity $\mu$; or a liquid by name, mass fraction in water and temperature, "
    '`"glycerol 85 %, 25 degC"`, with the extra `liquids`; of a `law` its viscosity at low rates (`cross`, `carreau`), '
    "or at `reference_rate`, beside the yield stress",
    "liquid.law": "how the viscosity depends on the shear rate",
    "liquid.flow_index": "$n$, slope of the stress over the rate where it thins; of `cross` and `carreau` at most 1",
    "liquid.relaxation_time": r"$\lambda$ of `cross` and `carreau`: over $1/\lambda$ the liquid thins",
    "liquid.infinite_shear_viscosity": r"$\mu_\infty$, what is left of the viscosity at high rates",
    "liquid.yield_stress": r"$\tau_y$ of `herschel-bulkley`",
    "liquid.reference_rate": "rate at which `viscosity` is that of the power law; with 1/s it is the consistency $K$",
    "liquid.plateau_rate": "rate below which the viscosity of a power law or yield stress stays what it is there: the "
    "regularisation; ten times below the slowest rate that matters it changes the force by 2 parts in 1000",
    "liquid.measured_to": "highest rate at which the viscosity was measured; a collision that is faster says so",
    "liquid.film_thickness": "$x_0$, the gap at initial contact: the sum of both coatings",
    "liquid.coating_thickness": "coating on each sphere; $x_0$ is twice that, or the sum with the partner's",
    "liquid.glass_transition_pressure": "$p_{gt}$, film pressure at which the liquid turns solid and the spheres "
    "rebound; without it there is no such criterion, and a roughness or elastic constants must stop the approach",
    "liquid.density": "density of the liquid; only reports the Reynolds number of the film",
    "bridge.surface_tension": r"surface tension $\sigma$",
    "bridge.volume": 'volume of the bridge over $R^3$, $R = 2a$; or with its unit, `"5e-5 mm^3"`; or `"from coating"`',
    "bridge.coating_fraction": 'with `"from coating"`: the part of either coating that flows into the bridge',
    "bridge.contact_angle": r"contact angle $\phi$",
    "bridge.law": "fit of the capillary force",
    "bridge.rupture": "where the bridge ruptures",
    "attraction.hamaker": "Hamaker constant $A$ of the two spheres across the liquid",
    "partner.radius": "radius of the partner; 1e-4 to 1e4 of the sphere's",
    "partner.diameter": "diameter $2R$ of the partner",
    "partner.coating_thickness": "coating on the partner; another sphere is coated as the first if nothing is said; "
    'beside a wall it must be said (`"0 um"`: dry)',
    "partner.mass": "mass of the partner; 1e-4 to 1e4 of the sphere's",
    "partner.density": "density of the partner; its mass follows from it",
    "partner.contact_angle": "contact angle on the partner, if another; the bridge has the angle of the mean cosine "
    "(Orr, Scriven & Rivas 1975, *J. Fluid Mech.* 67, 723), exact for small bridges",
    "partner.wall": "the partner is a flat wall at rest",
    "pendulum.length": "length $l$ of the strings",
    "pendulum.gravity": "acceleration of gravity $g$",
    "pendulum.law": "geometry of the strings",
    "model.arm": "lever arm of the tangential force about each centre",
    "model.tangential": "outer cut-off of the tangential logarithm",
    "model.glass": "pressure that the glass criterion looks at",
    "model.film": "normal lubrication force",
    "model.contact_friction": "rebounds that have friction, where there is `particles.friction`",
    "impact.stokes": r"normal Stokes number $St = m v_0/(6 \pi \mu a^2)$",
    "impact.speed": "$v_0$, the *normal* component of the approach velocity",
    "impact.relative_speed": r"magnitude of the relative velocity, $v_0/\cos\theta_0$",
    "impact.angle": r"$\theta_0$ between the relative velocity and the line of centres; 0 is along it",
    "impact.spin": "spin of the spheres, or of the first one, before the collision: positive in the sense in which "
    r"$\theta_0 > 0$ turns the line of centres, beside a wall in the sense of rolling along the tangential velocity",
    "impact.partner_spin": "spin of the partner, or of the second of two equal spheres; left out, it equals the spin",
}
"""Dotted name -> what the entry is."""

CHOICES = {
    "liquid.law": {
        "newtonian": r"$\mu$ at any rate; the default",
        "power-law": r"$\mu (\dot\gamma/\dot\gamma_r)^{n-1}$, above `plateau_rate`",
        "cross": r"$\mu_\infty + (\mu - \mu_\infty)/(1 + (\lambda \dot\gamma)^{1-n})$",
        "carreau": r"$\mu_\infty + (\mu - \mu_\infty)(1 + (\lambda \dot\gamma)^2)^{(n-1)/2}$",
        "herschel-bulkley": r"stress $\tau_y + \mu \dot\gamma_r^{1-n} \dot\gamma^n$, above `plateau_rate`; "
        "$n = 1$ is Bingham's",
    },
    "bridge.law": {
        "mikami": "regression of solutions of the Young-Laplace equation, natural logarithms; the paper's",
        "mikami-log10": "the same with decimal logarithms in two coefficients",
        "willett": "fit to solutions of the Young-Laplace equation, full form",
        "willett-simple": "its closed form for small bridges",
        "rabinovich": "`lambert` and the surface tension along the contact line",
        "lambert": "cylindrical bridge of constant volume, from its energy",
        "soulie": "Mikami's form refitted for polydisperse spheres",
        "constant": r"$2 \pi R \sigma \cos \phi$ at any gap: an upper bound",
    },
    "bridge.rupture": {
        "common": r"$x_f = 2a V^{1/3} (1 + \phi/2)$ with every law",
        "own": "the distance that the authors of the law give; an error where they give none",
    },
    "pendulum.law": {"exact": "strings of length $l$", "small-angle": "forces linear in the swing"},
    "model.arm": {"midgap": "$r/2$, halfway between the surfaces: conserves angular momentum"},
    "model.tangential": {"immersed": r"$\ln(2a/x)$, until $x = 2a$", "film": r"$\ln(x_0/x)$, inside the film only"},
    "model.glass": {
        "literal": r"$3 \mu a |u|/x^2$ as published; it can be met at initial contact",
        "film-corrected": "with the pressure at the rim of the film, $1/x^2 - 1/x_0^2$: zero at initial contact",
    },
    "model.contact_friction": {
        "solid": "those by solid contact (elastic, rough)",
        "all": "those on the liquid in its glassy state as well",
    },
    "model.film": {
        "finite": "film of thickness $x_0$, the same on approach and rebound; the paper's",
        "infinite": "no film correction; the force ends with a jump at $x_0$",
        "cavitating": "`finite` on approach; on rebound the liquid cavitates and does not resist",
        "constant-volume": "the rim holds the volume of the bridge, at any gap up to rupture; needs a bridge",
    },
}
"""Dotted name -> choice -> what it means."""
