"""Datasets: data read from text or from a store, and the problems that are posed of a dataset."""

from foon_asp.dataset.dataset import Dataset as Dataset
from foon_asp.dataset.dataset import pose_problem as pose_problem
from foon_asp.dataset.read_dataset import read_dataset as read_dataset
