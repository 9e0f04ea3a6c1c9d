//! The energy ledger: stored, supplied and dissipated energies, per body.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::common_motion::CommonMotion;
use crate::world::BodyId;

/// Kind of the energy in an account.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AccountKind {
    /// Energy held now: kinetic, strain, hourglass.
    Stored,
    /// Work done on the bodies since the start: gravity, prescribed motion, tractions.
    Supplied,
    /// Energy taken out of the motion since the start: damping, viscosity, plastic work.
    Dissipated,
}

/// Account of the dissipated energy that bodies hold as heat, with a negative sign: a part of plastic work
/// and friction that is not lost.
pub const INTO_HEAT: &str = "into_heat";

/// Account of the energy that removed particles take along.
pub const REMOVED_ENERGY: &str = "removed";

const KINETIC: &str = "kinetic";

/// Account of the work of gravity.
pub const GRAVITY: &str = "gravity";

/// Name and kind of the account of a system.
#[derive(Clone, Copy, Debug)]
pub struct EnergyAccount {
    /// Name of the account.
    pub name: &'static str,
    /// Kind of its energies.
    pub kind: AccountKind,
}

/// One account of the ledger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Name, such as `kinetic` or `artificial_viscosity`.
    pub name: String,
    /// Kind.
    pub kind: AccountKind,
    per_body: Vec<f64>,
    /// Values stated by each system, by its number.
    stated: Vec<(u32, Vec<f64>)>,
}

/// Index of an account.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccountId(usize);

/// All accounts, J. The balance `stored - stored at the start - supplied + dissipated` is the error of the
/// run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    accounts: Vec<Account>,
    bodies: usize,
    stored_at_start: f64,
    largest: f64,
    /// Resolution: smaller energies are round-off, J.
    resolution: f64,
    /// Number of the system that runs.
    system: u32,
    /// Uniform motion of the scene; none if it is at rest.
    drift: Option<CommonMotion>,
}

impl Ledger {
    /// A ledger for that many bodies.
    pub fn new(bodies: usize) -> Self {
        Self { bodies, ..Self::default() }
    }

    /// The account of that name; it is opened if there is none.
    pub fn account(&mut self, name: &str, kind: AccountKind) -> AccountId {
        if let Some(k) = self.accounts.iter().position(|account| account.name == name) {
            return AccountId(k);
        }
        self.accounts.push(Account {
            name: name.to_owned(),
            kind,
            per_body: vec![0.0; self.bodies],
            stated: Vec::new(),
        });
        AccountId(self.accounts.len() - 1)
    }

    /// The accounts in the order in which they were opened.
    pub fn accounts(&self) -> &[Account] {
        &self.accounts
    }

    /// From here on energies are stated by that system.
    pub(super) fn enter(&mut self, system: usize) {
        self.system = system as u32;
    }

    /// States the current energy, J. It replaces the earlier statement of the same system; those of several
    /// systems for one account and body are added.
    pub fn set(&mut self, account: AccountId, body: BodyId, energy: f64) {
        let Account { per_body, stated, .. } = &mut self.accounts[account.0];
        let own = stated.iter().position(|(system, _)| *system == self.system).unwrap_or_else(|| {
            stated.push((self.system, vec![0.0; per_body.len()]));
            stated.len() - 1
        });
        stated[own].1[body.0] = energy;
        per_body[body.0] = stated.iter().map(|(_, energies)| energies[body.0]).sum();
    }

    /// Adds work done or energy dissipated in this step, J.
    pub fn add(&mut self, account: AccountId, body: BodyId, energy: f64) {
        self.accounts[account.0].per_body[body.0] += energy;
    }

    /// The energy of an account, all bodies together, J.
    pub fn total(&self, account: AccountId) -> f64 {
        self.accounts[account.0].per_body.iter().sum()
    }

    /// The energy of an account that one body has, J.
    pub fn of(&self, account: AccountId, body: BodyId) -> f64 {
        self.accounts[account.0].of(body)
    }

    /// The energy of the account of that name, all bodies together, J; zero if there is none.
    pub fn total_named(&self, name: &str) -> f64 {
        self.accounts.iter().filter(|a| a.name == name).flat_map(|a| &a.per_body).sum()
    }

    fn total_of(&self, kind: AccountKind) -> f64 {
        self.accounts.iter().filter(|a| a.kind == kind).flat_map(|a| &a.per_body).sum()
    }

    /// All stored energy, J.
    pub fn stored(&self) -> f64 {
        self.total_of(AccountKind::Stored)
    }

    /// All work done on the bodies since the start, J.
    pub fn supplied(&self) -> f64 {
        self.total_of(AccountKind::Supplied)
    }

    /// All stored energy at the start, J.
    pub fn stored_at_start(&self) -> f64 {
        self.stored_at_start
    }

    /// Opens the energy balance: the currently stored energy is that at the start, and nothing is supplied or
    /// dissipated yet. The scene as a whole moves by `drift`.
    pub(crate) fn open(&mut self, drift: Option<CommonMotion>) {
        self.drift = drift;
        for account in self.accounts.iter_mut().filter(|account| account.kind != AccountKind::Stored) {
            account.per_body.fill(0.0);
        }
        self.stored_at_start = self.stored();
        self.close_step();
    }

    /// Closes a step: takes the scale of the balance error. Of removed particles it is not known what the
    /// uniform motion adds to the energy that they take along: from then on the scene counts as at rest.
    pub fn close_step(&mut self) {
        if self.total_named(REMOVED_ENERGY) != 0.0 {
            self.drift = None;
        }
        let resolution = self.drift.as_ref().map_or(0.0, CommonMotion::resolution);
        let turnover = self.accounts.iter().map(|account| self.relative(account).abs());
        self.largest = turnover.fold(self.largest, f64::max).max(self.other_work().abs()).max(resolution);
        self.set_resolution(resolution);
    }

    /// The uniform motion of the scene, if there is one.
    pub(crate) fn drift(&self) -> Option<&CommonMotion> {
        self.drift.as_ref()
    }

    /// Velocity of the frame in which energies are compared, m/s.
    pub fn frame(&self) -> DVec3 {
        self.drift.as_ref().map_or(DVec3::ZERO, |drift| drift.velocity)
    }

    /// The uniform motion, whose energies the caller states anew in every step.
    pub(crate) fn drift_mut(&mut self) -> Option<&mut CommonMotion> {
        self.drift.as_mut()
    }

    /// Energy of an account without what the uniform motion of the scene adds, J. Where there is one, zero
    /// for the works of forces other than gravity, of which only the sum is known.
    fn relative(&self, account: &Account) -> f64 {
        let Some(drift) = &self.drift else { return account.total() };
        match (account.name.as_str(), account.kind) {
            (KINETIC, _) => account.total() - drift.total(),
            (GRAVITY, _) => account.total() - drift.gravity,
            (_, AccountKind::Supplied) => 0.0,
            _ => account.total(),
        }
    }

    /// Work of forces other than gravity, without that which the uniform motion of the scene adds, J; zero
    /// where there is no such motion.
    fn other_work(&self) -> f64 {
        let Some(drift) = &self.drift else { return 0.0 };
        let is_other = |account: &&Account| account.kind == AccountKind::Supplied && account.name != GRAVITY;
        let work: f64 = self.accounts.iter().filter(is_other).map(Account::total).sum();
        work - drift.others()
    }

    /// Kinetic energy of all bodies without that of the uniform motion of the scene, J.
    pub fn motion(&self) -> f64 {
        self.total_named(KINETIC) - self.drift.as_ref().map_or(0.0, CommonMotion::total)
    }

    /// What the uniform motion of the scene adds to an account of a body, J, if that is known.
    pub fn drift_of(&self, account: &Account, body: BodyId) -> f64 {
        let is_kinetic = account.name == KINETIC;
        self.drift.as_ref().filter(|_| is_kinetic).map_or(0.0, |drift| drift.kinetic[body.0])
    }

    /// Magnitudes of the works on all bodies, added up, without what the uniform motion of the scene adds, J.
    pub fn turnover(&self) -> f64 {
        let supplied = self.accounts.iter().filter(|account| account.kind == AccountKind::Supplied);
        supplied.map(|account| self.relative(account).abs()).sum::<f64>() + self.other_work().abs()
    }

    /// The part of `work` of boundaries, J, that is not spent on the uniform motion of the scene.
    pub fn without_drift(&self, work: f64) -> f64 {
        if self.drift.is_some() { self.other_work() } else { work }
    }

    /// States a resolution below which energies are round-off, J; the largest stated one counts.
    pub fn set_resolution(&mut self, energy: f64) {
        self.resolution = self.resolution.max(energy);
    }

    /// Energies below this are round-off, J.
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// The largest energy that any account has held, without what the uniform motion of the scene adds, J.
    pub fn largest(&self) -> f64 {
        self.largest
    }

    /// The balance error, J.
    pub fn balance_error(&self) -> f64 {
        self.stored() - self.stored_at_start - self.supplied() + self.total_of(AccountKind::Dissipated)
    }

    /// The balance error over the largest energy that any account has held, or over the energy below which
    /// all is round-off where that is larger.
    pub fn relative_error(&self) -> f64 {
        let scale = self.largest.max(self.resolution);
        if scale > 0.0 { self.balance_error() / scale } else { 0.0 }
    }
}

impl Account {
    /// Energy of one body, J.
    pub fn of(&self, body: BodyId) -> f64 {
        self.per_body[body.0]
    }

    /// Energy of all bodies, J.
    pub fn total(&self) -> f64 {
        self.per_body.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_balance_closes_when_every_joule_is_booked() {
        let mut ledger = Ledger::new(2);
        let kinetic = ledger.account("kinetic", AccountKind::Stored);
        let gravity = ledger.account("gravity", AccountKind::Supplied);
        let damping = ledger.account("damping", AccountKind::Dissipated);
        ledger.set(kinetic, BodyId(0), 3.0);
        ledger.add(gravity, BodyId(0), 9.0);
        ledger.open(None);
        ledger.set(kinetic, BodyId(1), 4.0);
        ledger.add(gravity, BodyId(1), 5.0);
        ledger.add(damping, BodyId(1), 1.0);
        ledger.close_step();
        assert_eq!(ledger.balance_error(), 0.0);
        ledger.add(gravity, BodyId(0), 0.7);
        assert!((ledger.relative_error() + 0.1).abs() < 1e-12);
        assert_eq!(ledger.account("kinetic", AccountKind::Stored), kinetic);
    }

    #[test]
    fn round_off_is_no_balance_error() {
        let mut ledger = Ledger::new(1);
        let strain = ledger.account("strain", AccountKind::Stored);
        ledger.set_resolution(1e-8);
        ledger.open(None);
        ledger.set(strain, BodyId(0), 2e-14);
        ledger.close_step();
        assert!(ledger.relative_error() < 1e-5);
        ledger.set(strain, BodyId(0), 2.0);
        ledger.close_step();
        assert_eq!(ledger.relative_error(), 1.0);
    }

    #[test]
    fn what_two_systems_hold_in_one_account_is_added_up() {
        let mut ledger = Ledger::new(2);
        let springs = ledger.account("springs", AccountKind::Stored);
        for (first, second) in [(1.0, 2.0), (5.0, 3.0)] {
            ledger.enter(4);
            ledger.set(springs, BodyId(1), first);
            ledger.enter(7);
            ledger.set(springs, BodyId(1), second);
            assert_eq!(ledger.total(springs), first + second);
        }
        ledger.enter(4);
        ledger.set(springs, BodyId(1), 0.0);
        assert_eq!(ledger.accounts()[0].of(BodyId(1)), 3.0);
        // What is added corrects what has been stated, until it is stated anew.
        ledger.add(springs, BodyId(1), 0.5);
        assert_eq!(ledger.total(springs), 3.5);
    }
}
