"""Laws of finite strain against FEniCSx: a bar is bent and stretched in steps, each held until it is at rest.

FEniCSx solves the statics with its own mesh (gmsh, by ../shared/simulator) and its own derivatives of the energy. `estimate`
gets the positions of the vertices of a coarser mesh, with noise, and the force. It finds Young's modulus with the law and
without it. Prints the table of doc/method/finite_strain.md.
"""
import json
import os
import subprocess
import sys

import numpy as np

YOUNG_MODULUS = 20e3
LENGTH, WIDTH = 0.1, 0.02
FORCE = np.array([1.6, 0.12, 0.08])  # [N] on the end face
HOLD, STEPS = 2.0, 24                # [s] each, and how many
NOISE = 1e-4                         # [m]
POISSON_RATIO = {'nearly_incompressible': 0.499, 'incompressible': 0.4999}  # of these; 0.45 of the others
LAWS = {  # what the tool's model has beside neo-Hookean elasticity
    'neo_hookean': '',
    'nearly_incompressible': '',
    'incompressible': '',
    'mooney_rivlin': 'mooney_rivlin: {share: 0.7}',
    'ogden': 'ogden: {exponent: -4}',
    'strain_stiffening': 'strain_stiffening: {exponent: 2}',
    'holzapfel_gasser_ogden': 'holzapfel_gasser_ogden: {direction: [1, 0.5, 0], stiffness: 4e3, exponent: 1.5, dispersion: 0.1}',
}


def poisson_ratio(law):
    return POISSON_RATIO.get(law, 0.45)


def lame(law):
    nu = poisson_ratio(law)
    return YOUNG_MODULUS * nu / (1 + nu) / (1 - 2 * nu), YOUNG_MODULUS / 2 / (1 + nu)


def energy(ufl, law, f):
    """psi(F) [Pa]. The tool's formulas, but UFL takes the derivatives."""
    first_lame, shear = lame(law)
    c, j = f.T * f, ufl.det(f)
    first, second = ufl.tr(c), (ufl.tr(c) ** 2 - ufl.tr(c * c)) / 2
    neo_hookean = shear / 2 * (first - 3 - 2 * ufl.ln(j)) + first_lame / 2 * ufl.ln(j) ** 2
    if law == 'mooney_rivlin':
        return neo_hookean + 0.7 * shear / 2 * (j ** (-4 / 3) * second - j ** (-2 / 3) * first)
    if law == 'ogden':  # the sum of lambda^-4 is tr C^-2
        inverse = ufl.inv(c)
        return neo_hookean + shear / 8 * j ** (4 / 3) * ufl.tr(inverse * inverse) - shear / 2 * j ** (-2 / 3) * first
    if law == 'strain_stiffening':
        return YOUNG_MODULUS / 4 * (ufl.exp(4 * neo_hookean / YOUNG_MODULUS) - 1)
    if law == 'holzapfel_gasser_ogden':
        along = np.array([1, 0.5, 0]) / np.sqrt(1.25)
        a = f * ufl.as_vector(list(along))
        x = 0.1 * (j ** (-2 / 3) * first - 3) + 0.7 * (j ** (-2 / 3) * ufl.inner(a, a) - 1)
        return neo_hookean + ufl.conditional(ufl.gt(x, 0), 4e3 / 3 * (ufl.exp(1.5 * x ** 2) - 1), 0 * x)
    return neo_hookean


def elements(ufl, law, cell):
    """Displacements of second order, and for nearly incompressible tissue a pressure of first order (Taylor and Hood)."""
    displacement = ufl.VectorElement('CG', cell, 2)
    if law not in POISSON_RATIO:
        return displacement
    return ufl.MixedElement(displacement, ufl.FiniteElement('CG', cell, 1))


def potential(ufl, law, state):
    """psi, and the displacement in it."""
    if law not in POISSON_RATIO:
        return energy(ufl, law, ufl.Identity(3) + ufl.grad(state)), state
    first_lame, shear = lame(law)
    u, pressure = ufl.split(state)
    f = ufl.Identity(3) + ufl.grad(u)
    logarithm = ufl.ln(ufl.det(f))
    return shear / 2 * (ufl.inner(f, f) - 3 - 2 * logarithm) + pressure * logarithm - pressure ** 2 / (2 * first_lame), u


def solve(simulate, law, nodes):
    """Displacements of `nodes` at rest and after each step, (STEPS + 1) x n x 3."""
    import dolfinx
    import dolfinx.nls.petsc
    import ufl
    from dolfinx import fem
    from dolfinx.io import gmshio
    from mpi4py import MPI

    model = simulate.gmsh_mesh(bar(simulate), 0.006, 1, name='sim')
    mesh, _, _ = gmshio.model_to_mesh(model.model, MPI.COMM_SELF, 0, gdim=3)
    model.finalize()
    space = fem.FunctionSpace(mesh, elements(ufl, law, mesh.ufl_cell()))
    state, test = fem.Function(space), ufl.TestFunction(space)
    psi, u = potential(ufl, law, state)
    end = dolfinx.mesh.locate_entities_boundary(mesh, 2, lambda x: np.abs(x[0] - LENGTH) < 1e-6)
    tags = dolfinx.mesh.meshtags(mesh, 2, np.sort(end), np.ones(len(end), np.int32))
    ds = ufl.Measure('ds', mesh, subdomain_data=tags)(1)
    dx = ufl.Measure('dx', mesh, metadata={'quadrature_degree': 4})
    held = dolfinx.mesh.locate_entities_boundary(mesh, 2, lambda x: np.abs(x[0]) < 1e-6)
    if law in POISSON_RATIO:
        own, dofs = space.sub(0).collapse()
        clamp = fem.dirichletbc(fem.Function(own), fem.locate_dofs_topological((space.sub(0), own), 2, held), space.sub(0))
    else:
        own, dofs = space, slice(None)
        clamp = fem.dirichletbc(np.zeros(3), fem.locate_dofs_topological(space, 2, held), space)
    traction = fem.Constant(mesh, np.zeros(3))
    problem = fem.petsc.NonlinearProblem(ufl.derivative(psi * dx - ufl.inner(traction, u) * ds, state, test), state, [clamp])
    newton = dolfinx.nls.petsc.NewtonSolver(MPI.COMM_SELF, problem)
    newton.rtol = 1e-9
    newton.krylov_solver.setType('preonly')
    newton.krylov_solver.getPC().setType('lu')
    newton.krylov_solver.getPC().setFactorSolverType('mumps')
    to_nodes, _ = simulate.p2_interp_matrix(own.tabulate_dof_coordinates(), own.dofmap.list.array.reshape(-1, 10), nodes)
    out = [np.zeros(nodes.shape)]
    for k in range(1, STEPS + 1):
        traction.value[:] = FORCE / WIDTH ** 2 * k / STEPS
        newton.solve(state)
        out.append(to_nodes @ state.x.array[dofs].reshape(-1, 3))
    return np.array(out)


BODY = {'body': {'type': 'bar', 'h': 0.006, 'h_obs': 0.011, 'L': LENGTH, 'W': WIDTH, 'H': WIDTH}}


def bar(simulate):
    config = simulate.copy.deepcopy(simulate.DEFAULTS)
    simulate.deep_update(config, BODY)
    return config


def write_recording(folder, simulate, law, seed):
    config = bar(simulate)
    nodes, tets = simulate.linear_mesh(config, config['body']['h_obs'])
    simulate.write_vtk_tets(os.path.join(folder, 'mesh.vtk'), nodes, tets)
    surface = np.unique(simulate.surf_linear(nodes, tets))
    moved = solve(simulate, law, nodes[surface])
    random = np.random.default_rng(seed)
    with open(os.path.join(folder, 'points.csv'), 'w') as out:
        for k in range(STEPS + 1):
            seen = nodes[surface] + moved[k] + NOISE * random.standard_normal(moved[k].shape)
            for vertex, x in zip(surface, seen):
                out.write('%.9g,%d,%.9g,%.9g,%.9g\n' % (max(0.0, k * HOLD - 1e-3), vertex, *x))
    with open(os.path.join(folder, 'force.csv'), 'w') as out:
        out.write('0,0,0,0\n')
        for k in range(STEPS):
            out.write('%.9g,%.9g,%.9g,%.9g\n' % (k * HOLD + 0.5, *(FORCE * (k + 1) / STEPS)))
            out.write('%.9g,%.9g,%.9g,%.9g\n' % ((k + 1) * HOLD, *(FORCE * (k + 1) / STEPS)))
    return np.abs(moved).max()


def model_text(law, entry):
    return '\n'.join([
        'mesh: {file: mesh.vtk}',
        'regions:',
        '  clamp: {box: {min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}',
        '  end: {box: {min: [%.9g, -1, -1], max: [1, 1, 1]}}' % (LENGTH - 1e-6),
        'effects:',
        '  - inertia: {density: 1000}',
        '  - elasticity: {law: neo_hookean, poisson_ratio: %g, young_modulus: {prior: 30e3, factor: 2}}' % poisson_ratio(law),
        '  - fixed: {region: clamp}',
        '  - mass_damping: {alpha: 20}',
        '  - traction: {region: end, topic: /tool/wrench}'] + (['  - ' + entry] if entry else []) + [
        'observations:',
        '  - vertices: {topic: /tissue/vertices, noise: %g}' % NOISE,
        'inputs: exact', 'time: {step: 0.05}', ''])


def estimate(program, folder, name, law, entry):
    model = os.path.join(folder, name + '.yaml')
    with open(model, 'w') as out:
        out.write(model_text(law, entry))
    output = os.path.join(folder, name)
    done = subprocess.run([program, model, '--data', '/tissue/vertices=' + os.path.join(folder, 'points.csv'),
                           '/tool/wrench=' + os.path.join(folder, 'force.csv'), '--output', output, '--quiet'],
                          capture_output=True, text=True)
    if done.returncode not in (0, 3):
        raise RuntimeError(done.stderr)
    return json.load(open(os.path.join(output, 'results.json')))


def words(result):
    e = result['parameters']['elasticity.young_modulus']
    off = [100 * (value / YOUNG_MODULUS - 1) for value in (e['mean'], *e['interval95'])]
    return '%+.1f %% (%+.1f to %+.1f), `%s`' % (*off, result['state'])


def main(root, output, program, *laws):
    sys.path.insert(0, os.path.join(root, '..', 'shared', 'simulator'))
    import simulate
    print('| law | largest displacement | E off, with the law | E off, with neo-Hookean alone |\n|---|---|---|---|')
    for law, entry in LAWS.items():
        if laws and law not in laws:
            continue
        folder = os.path.join(output, law)
        os.makedirs(folder, exist_ok=True)
        most = write_recording(folder, simulate, law, 1)
        alone = words(estimate(program, folder, 'alone', law, '')) if entry else ''
        print('| %s | %.0f mm | %s | %s |' % (law, 1e3 * most, words(estimate(program, folder, 'with', law, entry)), alone), flush=True)


if __name__ == '__main__':
    main(*sys.argv[1:])
