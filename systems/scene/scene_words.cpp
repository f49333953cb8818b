#include "systems/scene/scene_words.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace minamo {

namespace {

using Of = OtherWord::Of;

/// Words of one meaning, apart by spaces.
struct Meaning {
  Of of;
  std::string_view means;
  std::string_view words;
  std::string_view expected = {};
};

// Of words that stand twice, the meaning counts whose key the object has; of no such key, the first pointer.
constexpr auto meanings = std::to_array<Meaning>({
    // The scene.
    {Of::key, "/title", "name description case label project comment"},
    {Of::key, "/dimension", "dim dims ndim n_dim dimensions spatial_dimension"},
    {Of::key, "/constants", "parameters params variables vars defines macros"},
    {Of::key, "/exact", "analytical analytic exact_solution reference_solution"},
    // The box.
    {Of::key, "/grid",
     "domain computational_domain simulation_box bounding_box box bounds block_mesh_dict mesh container",
     R"({"low": [...], "high": [...], "cells": [...]})"},
    {Of::key, "/grid/cells",
     "dx delta_x spacing grid_spacing resolution grid_resolution res cell_size grid_size n_grid n_cells n nx "
     "max_level init_grid refine divisions h cells",
     "counts per direction; the spacing is (high - low)/cells"},
    {Of::key, "/grid/low", "origin xmin xlo point_min domain_min lower_corner low"},
    {Of::key, "/grid/high", "xmax xhi point_max domain_max upper_corner high"},
    {Of::key, "/grid/high", "size domain_size lengths length extent l0 dimensions width",
     "the opposite corner: low plus the size"},
    {Of::key, "/walls", "boundaries boundary_conditions boundary_condition boundary_field bc bcs sides wall periodic",
     R"("slip", "no_slip", or one per axis, like {"x": "periodic"})"},
    // The liquid and what drives it.
    {Of::key, "/fluid", "liquid material phase medium transport_properties physical_properties properties"},
    {Of::key, "/fluids", "liquids materials phases"},
    {Of::key, "/fluid/density", "rho rho0 density0 rhop0 mass_density density"},
    {Of::key, "/fluid/viscosity", "mu mu1 eta visc visco dynamic_viscosity viscosity", "the dynamic viscosity [Pa s]"},
    {Of::key, "/fluid/viscosity", "nu kinematic_viscosity", "the dynamic viscosity, density times nu [Pa s]"},
    {Of::key, "/fluid/rheology", "non_newtonian viscosity_model transport_model rheology_model constitutive_law"},
    {Of::key, "yield_stress", "tau0 tau_y tau_yield yield"},
    {Of::key, "consistency", "k consistency_index"},
    {Of::key, "index", "n power exponent flow_index power_law_index"},
    {Of::key, "bingham", "bingham_plastic"},
    {Of::key, "carreau", "bird_carreau carreau_yasuda"},
    {Of::key, "power_law", "ostwald ostwald_de_waele"},
    {Of::key, "/body_force", "gravity g gravitation gravity_vector acceleration body_acceleration external_force force",
     "a list per axis, with its sign, like [0, -9.81] m/s^2"},
    {Of::key, "/surface_tension", "sigma gamma tension surface_tension_coefficient capillarity",
     R"({"coefficient": ...} [N/m])"},
    {Of::key, "coefficient", "sigma gamma value"},
    {Of::key, "contact_angle", "theta wetting_angle equilibrium_angle"},
    {Of::key, "/sponge", "wave_absorber absorber relaxation_zone damping_zone damping sponge_layer"},
    // Regions of liquid.
    {Of::key, "/particles",
     "fluid_blocks fluid_block fluid_models regions region initial_conditions initial_condition initial set_fields "
     "water blocks volumes",
     R"(a list of {"shape": ...})"},
    {Of::key, "shape",
     "box ball sphere circle polygon cylinder cube mesh geometry region where low high center radius type",
     R"("shape": {"box": {"low": [...], "high": [...]}}, or another shape in the place of "box")"},
    {Of::key, "/particles/*/per_cell", "ppc particles_per_cell nppc npc particles_per_direction per_cell",
     "per direction: 3 are 9 in a cell of the plane, 27 in 3-D"},
    {Of::key, "/particles/*/per_cell", "dp particle_spacing particle_radius particle_size inter_particle_distance",
     "per cell and direction: the spacing of the grid over that of the particles"},
    {Of::key, "/particles/*/arrangement", "packing sampling dense_mode distribution placement jitter random"},
    {Of::key, "/particles/*/velocity", "initial_velocity v vel u v0 u0 speed velocity"},
    // Shapes.
    {Of::key, "low", "min lo lower start begin"},
    {Of::key, "high", "max hi upper end stop"},
    {Of::key, "ball", "sphere circle disc disk drop droplet"},
    {Of::key, "box", "cube cuboid rectangle rect block square draw_box box_to_cell"},
    {Of::key, "ellipsoid", "ellipse spheroid"},
    {Of::key, "cylinder", "pipe tube rod"},
    {Of::key, "half_space", "plane halfplane"},
    {Of::key, "mesh", "stl obj triangles surface_mesh geometry_file tri_surface_mesh"},
    {Of::key, "distance", "sdf signed_distance level_set implicit phi"},
    {Of::key, "where", "function condition expression if fraction region mask"},
    {Of::key, "union", "or merge add sum"},
    {Of::key, "intersection", "and intersect"},
    {Of::key, "difference", "minus subtract subtraction cut"},
    {Of::key, "invert", "not complement inverse exterior outside"},
    {Of::key, "center", "centre position pos middle origin"},
    {Of::key, "radius", "r rad"},
    {Of::key, "radius", "diameter d", "half the diameter"},
    {Of::key, "radii", "axes semi_axes half_axes r"},
    {Of::key, "angle", "rotation rotate tilt rotation_angle"},
    {Of::key, "from", "start begin p1 point1"},
    {Of::key, "to", "end stop p2 point2"},
    {Of::key, "normal", "n direction"},
    {Of::key, "vertices", "points corners nodes"},
    {Of::key, "file", "filename path geometry_file"},
    {Of::key, "scale", "scaling factor"},
    {Of::key, "move", "translation translate offset shift"},
    // Bodies.
    {Of::key, "/bodies",
     "obstacles obstacle boundary solids solid rigid_bodies rigid_body rigid colliders collider objects structures "
     "immersed_boundary floatings",
     R"(a list of {"name": ..., "shape": ...}; the sides of the box are "walls")"},
    {Of::key, "/bodies/*/motion",
     "movement moving trajectory dynamic is_dynamic floating kinematics velocity density mass free prescribed",
     R"({"prescribed": {"velocity": [...]}}, {"table": {"file": ...}} or {"free": {"density": ...}})"},
    {Of::key, "/bodies/*/wall", "friction boundary_condition bc contact slip no_slip",
     R"("slip", "no_slip", "separating" or {"slip_length": ...})"},
    {Of::key, "prescribed", "imposed kinematic given"},
    {Of::key, "free", "floating dynamic rigid"},
    {Of::key, "rotation", "angular_velocity omega spin"},
    {Of::key, "rate", "angular_velocity omega spin"},
    // Openings.
    {Of::key, "/openings",
     "inlet outlet wind inlets outlets inflow outflow emitters emitter inlet_outlet jet drain source",
     R"(a list of {"name": ..., "side": ..., "inflow": ...} or {..., "outflow": ...})"},
    {Of::key, "inflow", "inlet wind emitter jet source fixed_value velocity rate",
     R"({"velocity": [...]} or {"rate": ...})"},
    {Of::key, "outflow", "outlet drain zero_gradient pressure level", R"("free", {"level": ...} or {"pressure": ...})"},
    {Of::key, "side", "face patch location plane direction boundary wall", "x_low, x_high, y_low, ..."},
    {Of::key, "rate", "flow_rate q flux discharge volume_flow"},
    {Of::key, "level", "h height depth water_level elevation surface"},
    // How it is computed.
    {Of::key, "/discretization", "elements element fem finite_element"},
    {Of::key, "/transfer", "interpolation advection p2g g2p mpm method simulation_method"},
    {Of::key, "/integrator", "time_integration time_scheme ddt_schemes integration"},
    {Of::key, "/solver", "linear_solver pressure_solver preconditioner"},
    {Of::key, "/solver/tolerance", "tol eps epsilon rel_tol max_error tolerance"},
    {Of::key, "/stabilization", "stabilisation stab supg"},
    {Of::key, "/volume", "volume_correction density_correction shifting"},
    {Of::key, "scheme", "method type name kind"},
    {Of::key, "blend", "flip_ratio flip_blend pic_flip_ratio alpha ratio"},
    // Time.
    {Of::key, "/time/step", "dt timestep delta_t step_size time_step_size dt_ini step"},
    {Of::key, "/time/end",
     "end_time t_end t_max time_max stop_at stop_time final_time duration total_time run_time end"},
    {Of::key, "/time/end", "steps n_steps max_steps num_steps iterations",
     "seconds; so many steps are --steps of the command line"},
    {Of::key, "/time/cfl", "courant courant_number max_co co cfl_number cfl_factor c_cfl cfl"},
    {Of::key, "/time/max_step", "dt_max max_dt max_delta_t max_time_step cfl_max_time_step_size max_step"},
    // Results.
    {Of::key, "/output/every",
     "write_interval output_interval dump_interval save_interval plot_interval frame_interval dump interval time_out "
     "dt_out output_every every",
     "seconds from one frame to the next"},
    {Of::key, "/output/every", "frames n_frames fps frame_rate data_export_fps frequency",
     "seconds from one frame to the next: one over the rate"},
    {Of::key, "/output/checkpoint", "restart restart_interval checkpoint_interval snapshot snapshot_interval backup"},
    {Of::key, "/probes", "sensors sensor monitors monitor probe measure_points",
     R"(a list of {"name": ..., "at": [...]})"},
    {Of::key, "/gauges", "gauge wave_gauges wave_gauge wave_probes water_levels surface_elevation interface_height",
     R"(a list of {"name": ..., "at": [...]})"},
    {Of::key, "/meters", "meter flow_meters flow_meter flux_planes flux_plane flow_rates surface_field_value",
     R"(a list of {"name": ..., "plane": {...}})"},
    {Of::key, "/patches", "patch pressure_patches force_patches pressure_sensors force_sensors",
     R"(a list of {"name": ..., "body": ...})"},
    {Of::key, "at", "position pos point location coordinates"},

    // Names.
    {Of::name, "slip", "free_slip symmetry symmetric symmetry_plane frictionless mirror reflecting"},
    {Of::name, "no_slip", "stick sticky fixed non_slip adhesion rough"},
    {Of::name, "periodic", "cyclic wrap p"},
    {Of::name, "separating", "separate separable unilateral"},
    {Of::name, "conforming", "staggered mac raviart_thomas"},
    {Of::name, "equal_order", "nodal collocated q1q1"},
    {Of::name, "apic", "mls_mpm mls affine affine_pic"},
    {Of::name, "flip", "asflip pic_flip flip_pic"},
    {Of::name, "tpic", "mpm taylor_pic"},
    {Of::name, "midpoint", "rk2 implicit_midpoint symplectic"},
    {Of::name, "newmark", "trapezoidal crank_nicolson newmark_beta"},
    {Of::name, "umfpack", "direct lu sparse_lu superlu mumps pardiso cholmod"},
    {Of::name, "block", "cg pcg gmres bicgstab amg gamg multigrid iterative krylov"},
    {Of::name, "none", "off no false disabled"},
    {Of::name, "jittered", "random jitter poisson poisson_disk"},
    {Of::name, "lattice", "regular uniform cartesian grid"},
    {Of::name, "x_low", "left west xmin xlo"},
    {Of::name, "x_high", "right east xmax xhi"},
    {Of::name, "y_low", "bottom floor south ymin ylo"},
    {Of::name, "y_high", "top ceiling north ymax yhi"},
    {Of::name, "x", "left right x_low x_high"},
    {Of::name, "y", "bottom top floor lid y_low y_high"},
    {Of::name, "vtp", "vtk vtu paraview"},
    {Of::name, "ply", "obj stl"},

    // Expressions.
    {Of::expression, "&&", "and &"},
    {Of::expression, "||", "or |"},
    {Of::expression, "^", "** pow power np.power math.pow"},
    {Of::expression, "==", "="},
    {Of::expression, "== 0", "not !"},
    {Of::expression, "pi", "math.pi np.pi numpy.pi M_PI PI Pi"},
    {Of::expression, "exp(1)", "e"},
    {Of::expression, "t", "time"},
    {Of::expression, "condition ? yes : no", "if where np.where"},
    {Of::expression, "abs", "fabs np.abs math.fabs"},
    {Of::expression, "sign", "sgn signum np.sign"},
    {Of::expression, "rint", "round nint"},
    {Of::expression, "rint(x - 0.5)", "floor math.floor np.floor"},
    {Of::expression, "asin", "arcsin np.arcsin"},
    {Of::expression, "acos", "arccos np.arccos"},
    {Of::expression, "atan", "arctan np.arctan"},
    {Of::expression, "atan2", "arctan2 np.arctan2"},
    {Of::expression, "sin", "np.sin math.sin"},
    {Of::expression, "cos", "np.cos math.cos"},
    {Of::expression, "tan", "np.tan math.tan"},
    {Of::expression, "tanh", "np.tanh math.tanh"},
    {Of::expression, "exp", "np.exp math.exp"},
    {Of::expression, "sqrt", "np.sqrt math.sqrt"},
    {Of::expression, "min", "fmin np.minimum"},
    {Of::expression, "max", "fmax np.maximum"},
});

std::vector<OtherWord> word_by_word() {
  std::vector<OtherWord> words;
  for (const Meaning& meaning : meanings) {
    for (std::string_view rest = meaning.words; !rest.empty();) {
      const std::string_view word = rest.substr(0, rest.find(' '));
      words.push_back({meaning.of, word, meaning.means, meaning.expected});
      rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    }
  }
  return words;
}

}  // namespace

std::span<const OtherWord> scene_words() {
  static const std::vector<OtherWord> words = word_by_word();
  return words;
}

}  // namespace minamo
