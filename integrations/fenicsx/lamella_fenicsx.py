"""Tissue of Lamella in FEniCSx (dolfinx 0.5): stresses and tangents at the quadrature points of a plane body.

    u = fem.Function(fem.VectorFunctionSpace(mesh, ("CG", 2)))
    tissue = Tissue(u, lamella.Database("tissue.h5"), turgor=2e4)
    body = Newton(tissue, bcs)
    body.solve()                # equilibrium; raises NoResponse where the increment is too large
    tissue.accept()             # the next increment begins with its states

SI units: mesh and u in m, P and dP/dF in Pa. The first Piola-Kirchhoff stress P and its tangent are functions in
quadrature spaces, UFL sees them as coefficients: `tissue.residual(v)` and `tissue.jacobian(du, v)` are forms. Plane
strain: F33 = 1.
"""
from collections import Counter

import basix
import numpy as np
import ufl
from dolfinx import fem
from petsc4py import PETSc

import lamella

# of quadratic elements, the points of `lamella fe2`: 3 x 3 of a quadrilateral, 3 of a triangle
_DEGREE = {"quadrilateral": 5, "triangle": 2}


class NoResponse(RuntimeError):
    """Material points have no response: `count` of them, `reasons` {reason: count}. The increment is too large, or
    the load beyond what the tissue bears or the database reaches."""

    def __init__(self, reasons, example):
        self.count, self.reasons = sum(reasons.values()), dict(reasons)
        listed = ", ".join(f"{n} {reason}" for reason, n in self.reasons.items())
        super().__init__(f"{self.count} material points without response ({listed}); {example}")


class NotConverged(RuntimeError):
    """Newton's method has not found an equilibrium."""


class _Queries:
    """Responses from a database, which knows no history."""

    def __init__(self, database, accuracy):
        self.database, self.accuracy = database, accuracy

    def respond(self, F, turgor, cohesion):
        return self.database.query(F, turgor, cohesion, self.accuracy)

    def accept(self):
        pass


class _Solves:
    """Responses of one RVE; each point has a state, from which its solves begin until the next one is accepted.

    A lamella that breaks in a jump may unload its point, so that iterates would go to and fro across the jump: as in
    `lamella fe2`, a point that has jumped stays behind the jump for loads near by.
    """

    NEARBY = 1e-3  # change of F, Frobenius norm: rve/solve/responder.c

    def __init__(self, rve, points):
        self.rve = rve
        rve.reset()
        self.latest = [rve.state] * points
        self.accept()

    def accept(self):
        self.accepted, self.jumped = list(self.latest), [None] * len(self.latest)

    def respond(self, F, turgor, cohesion):
        responses = np.zeros(len(F), lamella.Responses.dtype)
        for k, old in enumerate(self.jumped):
            behind = old is not None and np.linalg.norm(F[k] - old) <= self.NEARBY
            self.rve.state = self.latest[k] if behind else self.accepted[k]
            r = self.rve.solve(F[k], turgor[k], cohesion[k])
            responses[k], self.latest[k] = r.array, self.rve.state
            self.jumped[k] = F[k] if behind or r.jumped else None
        return lamella.Responses(responses)


class Tissue:
    """P and dP/dF of a displacement u at quadrature points.

    u: dolfinx vector function of a mesh in the plane, m. law: lamella.Database, or lamella.RVE, which is solved at each
    point. turgor, cohesion: Pa, numbers or arrays [cells, points of a cell], of the places `place()`; may be set at any
    time. accuracy: of queries. degree: of the quadrature; None: that of `lamella fe2`.
    """

    def __init__(self, u, law, turgor=0.0, cohesion=0.0, accuracy=0.01, degree=None):
        mesh = u.function_space.mesh
        name = mesh.ufl_cell().cellname()
        if mesh.geometry.dim != 2 or name not in _DEGREE:
            raise ValueError(f"a mesh of {name}s in {mesh.geometry.dim} dimensions: tissue is in plane strain, and its "
                             "meshes are of quadrilaterals or triangles in the plane")
        degree = _DEGREE[name] if degree is None else degree
        self.u, self.mesh, self.turgor, self.cohesion = u, mesh, turgor, cohesion
        self.dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": degree, "quadrature_rule": "default"})
        self._points, _ = basix.make_quadrature(basix.cell.string_to_type(name), degree)
        self._cells = np.arange(mesh.topology.index_map(2).size_local, dtype=np.int32)
        self.shape = (len(self._cells), len(self._points))  #: cells of this rank, points of a cell
        self._gradient = fem.Expression(ufl.grad(u), self._points)
        self._P, self.P = self._field(degree, (2, 2))  #: P of the last update, Pa, as UFL sees it
        self._A, self.tangent = self._field(degree, (2, 2, 2, 2))  #: dP_ij/dF_kl, Pa
        queries = isinstance(law, lamella.Database)
        if not queries:
            law.scene.check_material()
        self._law = _Queries(law, accuracy) if queries else _Solves(law, self.shape[0] * self.shape[1])
        self.stress_unit = law.stress_unit if queries else law.scene.stress_unit  #: C1 + C2 of the walls, Pa
        self.responses = None  #: of the last update, lamella.Responses [cells, points of a cell]

    def _field(self, degree, shape):
        """A tensor at the points: what sets its values, and the tensor as UFL sees it."""
        n = int(np.prod(shape))
        element = ufl.VectorElement("Quadrature", self.mesh.ufl_cell(), degree, dim=n, quad_scheme="default")
        space = fem.FunctionSpace(self.mesh, element)
        function = fem.Function(space)
        rows = space.dofmap.list.array.reshape(-1, self.shape[1])[:self.shape[0]]

        def fill(values):
            function.x.array.reshape(-1, n)[rows] = values.reshape(self.shape + (n,))
        return fill, ufl.as_tensor(np.reshape([function[k] for k in range(n)], shape).tolist())

    def place(self):
        """Places of the points in the undeformed body, m [cells, points of a cell, 2]."""
        X = fem.Expression(ufl.SpatialCoordinate(self.mesh), self._points).eval(self._cells)
        return X.reshape(self.shape + (2,))

    def deformation_gradient(self):
        """F at the points [cells, points of a cell, 2, 2]."""
        return self._gradient.eval(self._cells).reshape(self.shape + (2, 2)) + np.eye(2)

    def update(self):
        """Sets P and the tangent to those of u. Collective; raises NoResponse on all ranks, then without change."""
        F = self.deformation_gradient().reshape(-1, 2, 2)
        turgor, cohesion = (np.broadcast_to(x, self.shape).ravel() for x in (self.turgor, self.cohesion))
        r = self._law.respond(F, turgor, cohesion)
        P, A = r.P[:, :2, :2], r.tangent[:, :2, :2, :2, :2]
        known = np.isin(r.status, ("converged", "unstable"))  # `lamella fe2` takes both
        self._require(known & np.isfinite(P).all((1, 2)) & np.isfinite(A).all((1, 2, 3, 4)), r, F, turgor)
        self._P(P)
        self._A(A)
        self.responses = lamella.Responses(r.array.reshape(self.shape))

    def _require(self, known, r, F, turgor):
        """Raises NoResponse, on all ranks, unless all are known."""
        reasons, example = Counter(), ""
        if not known.all():
            bad = np.flatnonzero(~known)
            names = [f"{r.status[k]}: {r.reason[k]}" for k in bad]
            reasons.update(names)
            where = self.place().reshape(-1, 2)[bad[0]] * 1e3
            example = (f"the first at ({where[0]:.4g}, {where[1]:.4g}) mm: F = "
                       f"[{' '.join(f'{x:.5g}' for x in F[bad[0]].ravel())}], turgor {turgor[bad[0]]:.6g} Pa")
        everywhere = self.mesh.comm.allgather((reasons, example))
        total = sum((one for one, _ in everywhere), Counter())
        if total:
            raise NoResponse(total, next(words for _, words in everywhere if words))

    def accept(self):
        """Ends an increment: the states of the last update are those from which the points go on."""
        self._law.accept()

    def residual(self, v):
        """Virtual work of the internal forces."""
        return ufl.inner(self.P, ufl.grad(v)) * self.dx

    def jacobian(self, du, v):
        """Derivative of the residual along du."""
        i, j, k, l = ufl.indices(4)
        return self.tangent[i, j, k, l] * ufl.grad(du)[k, l] * ufl.grad(v)[i, j] * self.dx


class Newton:
    """Newton's method with full steps and a direct solver, for the equilibrium of a body.

    bcs: Dirichlet conditions; their values may change from one solve to the next. work: linear form of the virtual work
    of external forces, N per m of thickness, or None. tolerance: largest norm of the residual over C1 + C2 of the walls
    times the root of the body's area. most: iterations; where that is not enough the increment is too large.
    """

    def __init__(self, tissue, bcs, work=None, tolerance=1e-12, most=15):
        V = tissue.u.function_space
        v, du = ufl.TestFunction(V), ufl.TrialFunction(V)
        self.tissue, self.bcs, self.most = tissue, bcs, most
        self._internal, self._jacobian = fem.form(tissue.residual(v)), fem.form(tissue.jacobian(du, v))
        self._external = None if work is None else fem.form(work)
        area = tissue.mesh.comm.allreduce(fem.assemble_scalar(fem.form(fem.Constant(tissue.mesh, 1.0) * tissue.dx)))
        self._tolerance = tolerance * tissue.stress_unit * area**0.5
        self._K = fem.petsc.create_matrix(self._jacobian)
        self._solver = PETSc.KSP().create(tissue.mesh.comm)
        self._solver.setOperators(self._K)
        self._solver.setType("preonly")
        self._solver.getPC().setType("lu")
        self._solver.getPC().setFactorSolverType("mumps")
        self._step_vector = self._K.createVecRight()

    def _imbalance(self):
        """Internal less external forces, those of ghost nodes not yet added to their owners'."""
        b = fem.petsc.assemble_vector(self._internal)
        if self._external is not None:
            b.axpy(-1, fem.petsc.assemble_vector(self._external))
        return b

    def forces(self):
        """Internal less external forces of the nodes after the last update, N per m of thickness: a PETSc vector in the
        order of the degrees of freedom of u. In equilibrium these are the forces that hold nodes of the conditions."""
        b = self._imbalance()
        b.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        return b

    def _step(self, first):
        """Moves u by one iteration, which brings it to the conditions; False: it is in equilibrium, and stays."""
        u = self.tissue.u
        b = self._imbalance()
        fem.petsc.apply_lifting(b, [self._jacobian], [self.bcs], [u.vector], -1.0)
        b.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        fem.petsc.set_bc(b, self.bcs, u.vector, -1.0)
        if not first and b.norm() <= self._tolerance:
            return False
        self._K.zeroEntries()
        fem.petsc.assemble_matrix(self._K, self._jacobian, self.bcs)
        self._K.assemble()
        self._solver.solve(b, self._step_vector)
        u.vector.axpy(-1, self._step_vector)
        u.x.scatter_forward()
        return True

    def solve(self):
        """Brings u to equilibrium; returns the number of iterations. Raises NoResponse or NotConverged, then u is as
        it was."""
        x = self.tissue.u.x.array
        before = x.copy()
        try:
            for iteration in range(self.most + 1):
                self.tissue.update()
                if not self._step(iteration == 0):
                    return iteration
            raise NotConverged(f"no equilibrium after {self.most} iterations: make the increment smaller")
        except (NoResponse, NotConverged):
            x[:] = before
            raise
