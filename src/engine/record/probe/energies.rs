//! Energies of the ledger as columns of a series.

use serde::{Deserialize, Serialize};

use crate::schedule::Ledger;
use crate::world::BodyId;

/// Which energies a series has, and in which order. Accounts open when a system first books something, so the
/// columns are known only once all systems have run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyColumns {
    /// Bodies that the totals are taken over, with their names.
    bodies: Vec<(usize, String)>,
    /// Also every account of every body, and the balance.
    detailed: bool,
}

impl EnergyColumns {
    /// The accounts of the given bodies, each summed over them.
    pub fn of_bodies(bodies: Vec<(BodyId, String)>) -> Self {
        Self { bodies: bodies.into_iter().map(|(id, name)| (id.0, name)).collect(), detailed: false }
    }

    /// Everything: totals, bodies, and the balance.
    pub fn detailed(bodies: Vec<(BodyId, String)>) -> Self {
        Self { detailed: true, ..Self::of_bodies(bodies) }
    }

    /// Name and unit of the columns for these accounts.
    pub fn names(&self, accounts: &[String]) -> Vec<(String, &'static str)> {
        let mut names: Vec<(String, &str)> = accounts.iter().map(|account| (account.clone(), "J")).collect();
        if self.detailed {
            for (_, body) in &self.bodies {
                names.extend(accounts.iter().map(|account| (format!("{body}.{account}"), "J")));
            }
            names.extend([("balance_error".to_owned(), "J"), ("relative_error".to_owned(), "1")]);
        }
        names
    }

    /// The values of those columns; an account that is not open yet holds nothing.
    pub fn values(&self, accounts: &[String], ledger: &Ledger) -> Vec<f64> {
        let energy = |name: &String, body: usize| {
            let account = ledger.accounts().iter().find(|account| account.name == *name);
            account.map_or(0.0, |account| account.of(BodyId(body)))
        };
        let total = |name: &String| self.bodies.iter().map(|(body, _)| energy(name, *body)).sum::<f64>();
        let mut values: Vec<f64> = accounts.iter().map(total).collect();
        if self.detailed {
            for (body, _) in &self.bodies {
                values.extend(accounts.iter().map(|name| energy(name, *body)));
            }
            values.extend([ledger.balance_error(), ledger.relative_error()]);
        }
        values
    }

    /// Names of the accounts of a ledger.
    pub fn accounts(ledger: &Ledger) -> Vec<String> {
        ledger.accounts().iter().map(|account| account.name.clone()).collect()
    }
}
